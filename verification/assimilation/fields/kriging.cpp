#include "verification/assimilation/fields/kriging.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "backends/nlopt/minimise.hpp"
#include "backends/openblas/dense_algebra.hpp"
#include "backends/suitesparse/sparse_cholesky.hpp"
#include "kernel/core/random.hpp"
#include "verification/assimilation/fields/gaussian_field.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::assimilation {
namespace {

// Values that the prior is found by: it need not be known well.
constexpr Eigen::Index kPriorValues = 600;
// Lengths that are tried, over that which is begun with.
constexpr double kLengths[] = {0.5, 1, 2, 4, 8};
constexpr double kConverged = 1e-8;
constexpr int kMostIterations = 200;

// About so many rows of all, drawn at random but always alike, in their order.
std::vector<Eigen::Index> some_rows(Eigen::Index all, Eigen::Index wanted, std::uint64_t stream) {
  std::vector<Eigen::Index> rows;
  const double share = static_cast<double>(wanted) / static_cast<double>(all);
  for (Eigen::Index i = 0; i < all; ++i)
    if (uniform_random(statistics::fixed_seed::kriging_rows, stream,
                       static_cast<std::uint64_t>(i)) < share)
      rows.push_back(i);
  return rows;
}

PointTrace rows_of(const PointTrace& trace, const std::vector<Eigen::Index>& rows) {
  PointTrace result(static_cast<Eigen::Index>(rows.size()), trace.cols());
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (PointTrace::InnerIterator it(trace, rows[k]); it; ++it)
      entries.emplace_back(static_cast<int>(k), static_cast<int>(it.col()), it.value());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

std::vector<Point> points_of(const std::vector<Point>& points,
                             const std::vector<Eigen::Index>& rows) {
  std::vector<Point> result;
  for (const Eigen::Index row : rows) result.push_back(points[static_cast<std::size_t>(row)]);
  return result;
}

}  // namespace

// In units of the noise's level; K = T Σ Tᵀ + N is the covariance of the values.
struct Kriging::Data {
  const fem::SurfaceSpace& space;
  std::vector<Eigen::Index> rows;  // that are kriged
  PointTrace trace;
  double level, mean;
  Vec centred, deviation;
  NoiseWhitening noise;
  FieldPrior prior{};
  std::unique_ptr<GaussianField> field;
  Eigen::MatrixXd factors;  // of K

  Data(const fem::SurfaceSpace& own, const NoisyValues& measured, const std::vector<Point>& points,
       const CorrelatedNoise& stated, std::vector<Eigen::Index> chosen)
      : space(own),
        rows(std::move(chosen)),
        trace(rows_of(measured.trace, rows)),
        level(stated.level),
        mean(weighted_mean(measured)),
        centred((measured.values(rows).array() - mean) / stated.level),
        deviation(measured.deviation(rows)),
        noise(points_of(points, rows), stated.correlation) {}

  static double weighted_mean(const NoisyValues& measured) {
    const Vec weight = measured.deviation.cwiseAbs2().cwiseInverse();
    return measured.values.dot(weight) / weight.sum();
  }

  Eigen::MatrixXd noise_covariance() const {
    return deviation.asDiagonal() * Eigen::MatrixXd(noise.correlations()) * deviation.asDiagonal();
  }
  Vec times_noise(const Vec& x) const {
    return deviation.cwiseProduct(noise.correlations() * deviation.cwiseProduct(x));
  }
  // E of the values alone.
  Vec weights() const { return openblas::divided_by_factors(factors, centred).col(0); }
};

namespace {

// The prior that makes the values most probable: length by length, each with its smoothing.
FieldPrior most_probable_prior(const fem::SurfaceSpace& space, const PointTrace& trace,
                               const Eigen::MatrixXd& noise, const Vec& values,
                               const FieldPrior& near) {
  FieldPrior best = near;
  double least = std::numeric_limits<double>::infinity();
  for (const double factor : kLengths) {
    const double length = factor * near.length;
    const Eigen::MatrixXd root = GaussianField(space, {length, 1}).root_at(trace);
    const Eigen::MatrixXd unit = openblas::gram(root);
    nlopt::MinimiseRequest request;  // of the logarithm of the smoothing
    request.function = [&](const std::vector<double>& x) {
      const Eigen::MatrixXd L = openblas::cholesky_factor(std::exp(-x[0]) * unit + noise);
      return 2 * L.diagonal().array().log().sum() +
             values.dot(openblas::divided_by_factors(L, values).col(0));
    };
    const double start = std::log(near.smoothing);
    request.start = {start};
    request.lower = {start - 14};
    request.upper = {start + 14};
    request.step = {2};
    request.tolerance = 2e-2;
    request.most_evaluations = 25;
    const nlopt::Minimum minimum = nlopt::minimise(request);
    if (minimum.value >= least) continue;
    least = minimum.value;
    best = {length, std::exp(minimum.x[0])};
  }
  return best;
}

}  // namespace

Kriging::~Kriging() = default;

Kriging::Kriging(const fem::SurfaceSpace& space, const NoisyValues& measured,
                 const std::vector<Point>& points, const CorrelatedNoise& noise,
                 const FieldPrior& near) {
  const Eigen::Index all = measured.values.size();
  auto data = std::make_unique<Data>(space, measured, points, noise,
                                     some_rows(all, std::min(all, kMostKriged), 0));
  const Eigen::Index count = data->centred.size();
  const std::vector<Eigen::Index> few = some_rows(count, std::min(count, kPriorValues), 1);
  const Eigen::MatrixXd covariance = data->noise_covariance();
  data->prior = most_probable_prior(space, rows_of(data->trace, few), covariance(few, few),
                                    data->centred(few), near);
  data->field = std::make_unique<GaussianField>(space, data->prior);
  data->factors =
      openblas::cholesky_factor(openblas::gram(data->field->root_at(data->trace)) + covariance);
  data_ = std::move(data);
}

FieldEstimate Kriging::estimate(const ErrorRequest& wanted) const {
  const Data& d = *data_;
  const GaussianField& field = *d.field;
  const auto across = [&](const Eigen::MatrixXd& values) {  // Σ Tᵀ K⁻¹
    return field.covariance_times(
        Eigen::MatrixXd(d.trace.transpose() * openblas::divided_by_factors(d.factors, values)));
  };
  const Vec mean = d.level * across(d.centred).col(0);
  FieldEstimate result{field.projected(Vec(mean.array() + d.mean)), d.prior, d.level, {}, {}};
  if (wanted.rank > 0) {
    const auto posterior = [&](const Eigen::MatrixXd& X) -> Eigen::MatrixXd {
      const Eigen::MatrixXd before = field.covariance_times(X);
      return before - across(d.trace * before);
    };
    result.errors = field.projected(
        d.level * important_directions(field.matrices(), posterior, wanted.length, wanted.rank));
  }
  if (wanted.draws > 0) {
    const Eigen::MatrixXd before = field.draws(wanted.draws, wanted.stream);
    Eigen::MatrixXd noise(d.centred.size(), wanted.draws);
    for (Eigen::Index i = 0; i < noise.size(); ++i)
      noise.data()[i] = normal_random(statistics::fixed_seed::kriging_noise, wanted.stream,
                                      static_cast<std::uint64_t>(i));
    const Eigen::MatrixXd values =
        d.trace * before + d.deviation.asDiagonal() * d.noise.coloured(noise);
    result.draws = field.projected(d.level * (before - across(values)));
  }
  return result;
}

// Conjugate gradients for K⁻¹ y with the K of that mesh; the own one is nearly its inverse.
Vec Kriging::field_on(const fem::SurfaceSpace& other, const PointTrace& all) const {
  const Data& d = *data_;
  const GaussianField field(other, d.prior);
  const PointTrace trace = rows_of(all, d.rows);
  const auto load = [&](const Vec& x) -> Vec {
    return field.covariance_times(Vec(trace.transpose() * x)).col(0);
  };
  Vec x = Vec::Zero(d.centred.size()), residual = d.centred;
  Vec z = d.weights(), direction = z;
  double size = residual.dot(z);
  const double end = kConverged * kConverged * size;
  for (int k = 0; k < kMostIterations && size > end; ++k) {
    const Vec image = trace * load(direction) + d.times_noise(direction);
    const double step = size / direction.dot(image);
    x += step * direction;
    residual -= step * image;
    z = openblas::divided_by_factors(d.factors, residual).col(0);
    const double next = residual.dot(z);
    direction = z + next / size * direction;
    size = next;
  }
  return field.projected(Vec((d.level * load(x)).array() + d.mean)).col(0);
}

}  // namespace traceraft::assimilation
