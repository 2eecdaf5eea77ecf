// Fields from values whose noise neighbours share.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/support/spaces.hpp"
#include "verification/assimilation/fields/gaussian_field.hpp"
#include "verification/assimilation/fields/kriging.hpp"
#include "verification/selection/blind/noise_waves.hpp"

namespace traceraft::assimilation {
namespace {

using testing::make_space;

constexpr double kSpread = 0.05;
constexpr int kCount = 900;

double caps(const Point& x) {
  return 0.5 + 0.5 * std::tanh((std::fabs(x[2] + 0.2 * x[0]) - 0.6) / 0.2);
}

struct Shared {
  std::shared_ptr<const fem::SurfaceSpace> space = make_space(16);
  std::vector<Point> points;
  NoisyValues values;

  explicit Shared(double share) {
    for (int k = 0; k < kCount; ++k)
      points.push_back(testing::random_direction(5, static_cast<std::uint64_t>(k)));
    values.deviation = Vec::Ones(kCount);
    values.trace = point_trace(*space, points, space->h());
    values.values = kSpread * std::sqrt(share) *
                    selection::noise_waves(points, 0.1, selection::NoiseShape::gaussian, 5, 1);
    for (int k = 0; k < kCount; ++k)
      values.values[k] += caps(points[k]) + kSpread * std::sqrt(1 - share) * normal_random(5, 3, k);
  }
};

// The correlation is next to none: this is another way to the same posterior.
TEST(Kriging, OfWhiteNoiseIsTheOtherEstimate) {
  const Shared m(0);
  const FieldEstimate white = estimate_field(*m.space, m.values, {0.4, 40, 0});
  const NoiseCorrelation none{{{1e-6, 0.5}}};
  const Kriging kriging(*m.space, m.values, m.points, {white.noise, none}, white.prior);
  const FieldEstimate found = kriging.estimate({0.4, 40, 0});
  const FieldEstimate same = estimate_field(*m.space, m.values, found.prior, {0.4, 40, 0});
  const Vec a = m.values.trace * found.field, b = m.values.trace * same.field;
  EXPECT_LT((a - b).norm(), 1e-8 * b.norm());
  // Their noises differ: what is estimated there is known here.
  const double ratio = found.noise / same.noise;
  EXPECT_LT((found.errors * found.errors.transpose() -
             ratio * ratio * same.errors * same.errors.transpose())
                .norm(),
            1e-5 * found.errors.squaredNorm());
}

// The posterior in its dense form, on the traces.
TEST(Kriging, HasTheDensePosterior) {
  const Shared m(0.6);
  const NoiseCorrelation shared = gaussian_correlation(0.1, 0.6);
  const Kriging kriging(*m.space, m.values, m.points, {kSpread, shared}, {0.5, 1});
  const FieldEstimate found = kriging.estimate({0.4, 0, 3000});
  const GaussianField field(*m.space, found.prior);
  const Eigen::MatrixXd root = field.root_at(m.values.trace);
  const Eigen::MatrixXd prior = root.transpose() * root;
  const Eigen::MatrixXd noise(NoiseWhitening(m.points, shared).correlations());
  const double mean = m.values.values.mean();
  const Vec weights = (prior + noise).ldlt().solve(Vec(m.values.values.array() - mean));
  const Vec own = field.projected(field.covariance_times(m.values.trace.transpose() * weights) +
                                  Vec::Constant(m.space->nodes(), mean));
  EXPECT_LT((m.values.trace * (found.field - own)).norm(), 1e-9 * m.values.values.norm());
  // The draws have that covariance: of the mean of all traces, say.
  const Eigen::MatrixXd left = prior - prior * (prior + noise).ldlt().solve(prior);
  const double expected = kSpread * std::sqrt(left.mean());
  const Eigen::RowVectorXd means = (m.values.trace * found.draws).colwise().mean();
  EXPECT_NEAR(means.norm() / std::sqrt(3000.0), expected, 0.05 * expected);
}

// On another mesh the same field, to what the meshes differ by.
TEST(Kriging, GivesTheFieldOnAnotherMesh) {
  const Shared m(0.6);
  const Kriging kriging(*m.space, m.values, m.points, {kSpread, gaussian_correlation(0.1, 0.6)},
                        {0.5, 1});
  const auto finer = make_space(22);
  const PointTrace trace = point_trace(*finer, m.points, finer->h());
  const Vec there = trace * kriging.field_on(*finer, trace);
  const Vec here = m.values.trace * kriging.estimate({}).field;
  EXPECT_LT((there - here).norm(), 0.4 * kSpread * std::sqrt(kCount));
  const Vec same = m.values.trace * kriging.field_on(*m.space, m.values.trace);
  EXPECT_LT((same - here).norm(), 1e-5 * here.norm());
}

}  // namespace
}  // namespace traceraft::assimilation
