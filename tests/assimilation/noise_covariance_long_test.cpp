// Noise that neighbours share, through the whole filter.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/small_vesicle.hpp"
#include "verification/assimilation/filter/noise_levels.hpp"
#include "verification/selection/fit/score_test.hpp"

namespace traceraft::assimilation {
namespace {

// Nothing hidden, measured with noise of 10 %.
selection::BlindRequest vesicle(double share) {
  selection::BlindRequest asked = testing::small_vesicle(3);
  asked.effects = {};
  asked.noise = 0.1;
  asked.first = 40;
  asked.noise_share = share;
  asked.noise_correlation = 0.1;
  return asked;
}

struct Measured {
  selection::BlindRequest asked;
  selection::BlindCase drawn;
  FilterSettings settings;
  FilterModel model;
  FilterProblems data;

  explicit Measured(double share)
      : asked(vesicle(share)),
        drawn(selection::draw_blind_case(asked)),
        model{asked.base, 1, {}, {}} {
    settings.rank = 40;
    settings.replicates = 99;
    data = make_filter_problems(drawn.vesicles, geometry::make_surface("sphere"), asked.base, 12, 2,
                                false, settings);
  }
  FilterResult pass() const {
    std::vector<ErrorMaps> maps;
    return filter_fields(data, model, settings, maps);
  }
};

TEST(NoiseCovariance, IsFoundBesideTheStateAndMakesNoGap) {
  Measured m(0.7);
  const double gap_if_white = selection::screen(m.pass(), {}, {}).gap_p;
  bool settled = false;
  for (int k = 0; k < 4 && !settled; ++k)
    settled = !fit_noise_covariance(m.data, m.pass(), m.asked.base, m.settings);
  const NoiseCorrelation& found = m.data[0].correlation;
  EXPECT_NEAR(found.share(), 0.7, 0.2);
  EXPECT_NEAR(found.length(), 0.1, 0.03);
  EXPECT_NEAR(noise_of(m.data), m.drawn.noise, 0.1 * m.drawn.noise);
  const FilterResult pass = m.pass();
  EXPECT_GT(selection::screen(pass, {}, {}).gap_p, 0.01);
  EXPECT_LT(gap_if_white, 0.01);
  // Replicates are white in units of the noise, and shared at the points.
  const Innovation& in = pass.innovations.front();
  ASSERT_TRUE(in.whitening);
  EXPECT_TRUE(whitened(in, at_points(in, in.values)).isApprox(in.values, 1e-9));
  EXPECT_EQ(in.gap.size(), in.values.size());
}

// Where its size is known to some error only, each replicate has noise of a size of its own.
TEST(NoiseCovariance, HasReplicatesOfTheSizesThatItMayHave) {
  Measured m(0);
  const auto replicates = [&](double error) {
    m.data[0].correlation.error = error;
    return m.pass().innovations.front().replicates;
  };
  // The state's part is the same. Noise has norm √(values), so this is |size − 1|, with
  // size = exp(½ error z): its root mean square is 0.207.
  const Columns change = replicates(0.4) - replicates(0);
  const double values = static_cast<double>(change.rows());
  const Vec sizes = change.colwise().norm().transpose() / std::sqrt(values);
  EXPECT_NEAR(std::sqrt(sizes.squaredNorm() / static_cast<double>(sizes.size())), 0.207, 0.05);
}

TEST(NoiseCovariance, StaysWhiteWhereItIs) {
  Measured m(0);
  FilterProblems same = m.data;
  const FilterResult pass = m.pass();
  EXPECT_FALSE(fit_noise_covariance(m.data, pass, m.asked.base, m.settings));
  EXPECT_TRUE(m.data[0].correlation.white());
  fit_noise(same, pass);
  EXPECT_EQ(m.data[0].noise, same[0].noise);  // as without any of this
}

TEST(NoiseCovariance, CanBeGivenAndTakenBack) {
  Measured m(0);
  const Vec first = m.data[0].first.field;
  const NoiseModel white = noise_model(m.data);
  NoiseModel shared = white;
  shared.correlation = gaussian_correlation(0.1, 0.5);
  set_noise_model(shared, m.asked.base, m.settings, m.data);
  EXPECT_TRUE(noise_model(m.data) == shared);
  EXPECT_EQ(m.data[0].correlation.share(), 0.5);
  EXPECT_TRUE(m.data[0].whitening[2]);
  EXPECT_GT((m.data[0].first.field - first).norm(), 0);
  set_noise_model(white, m.asked.base, m.settings, m.data);
  EXPECT_FALSE(m.data[0].whitening[2]);
  EXPECT_EQ(m.data[0].first.field, first);
}

}  // namespace
}  // namespace traceraft::assimilation
