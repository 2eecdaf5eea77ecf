// Statistics of calibrations over many sets of data.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/simulated_rafts.hpp"
#include "verification/calibration/calibration.hpp"
#include "verification/calibration/calibration_data.hpp"

namespace traceraft::observations {
using namespace simulated_rafts;
namespace {

// Five vesicles and five runs: without the factor for few 81 of 120 sets hold the truth. Of 155
// sets more than 17 do not with a probability of 8e-4, and if it were 15 % with 91 %.
TEST(Calibration, KnowsHowLittleFewSay) {
  constexpr int kSets = 155, kFew = 5;
  PublishedFacts facts = design();
  facts.vesicles = kFew;
  facts.measurements = 4 * kFew;
  int held = 0;
  for (int seed = 1; seed <= kSets; ++seed) {
    std::vector<History> vesicles = simulate(kEpsilon, true, kFew, 1000 * seed);
    for (History& vesicle : vesicles)
      for (double& t : vesicle.time) t *= kSeconds;
    const calibration::Calibration found = calibration::calibrate(
        draw_from_runs(facts, vesicles, 5, seed), {},
        {{{}, simulate(kEpsilon, true, kFew, 500000 + 1000 * seed)}}, around(1.5 * kSeconds));
    held += found.parameters[0].interval.contains(kSeconds);
  }
  EXPECT_GE(held, kSets - 17);
  EXPECT_LT(held, kSets);
}

// 95 % are to hold the truth; fewer than 14 of 16 do once in 23 times then, with 0.7 in 100 of 101.
TEST(Calibration, FindsWhatTheDataDetermine) {
  int held = 0;
  std::vector<double> time_errors, epsilon_errors;
  constexpr int kSets = 16;
  for (int seed = 1; seed <= kSets; ++seed) {
    const calibration::Calibration found = calibrated(true, seed, 0.11);
    ASSERT_EQ(found.parameters.size(), 2u);
    EXPECT_TRUE(found.parameters[1].determined) << seed;
    time_errors.push_back(std::fabs(std::log(found.parameters[0].value / kSeconds)));
    epsilon_errors.push_back(std::fabs(std::log(found.parameters[1].value / kEpsilon)));
    held += found.parameters[1].interval.contains(kEpsilon);
  }
  // ln N scatters by N^(-1/2) between vesicles, and goes with −2/3 x/(1 + x) ln t, x = ε² t: of one
  // vesicle ln t is known to 0.4 at best (x = 4, N = 20), of 17 to 0.1, and a little worse with 40
  // simulations and looks that do not share information as well as that. At a given time ln N goes
  // with −3 ln ε, so that an error of ε makes one of time that is six times as large.
  EXPECT_LT(statistics::quantile(epsilon_errors, 0.5), 0.02);
  EXPECT_LT(statistics::quantile(time_errors, 0.5), 0.15);
  EXPECT_GE(held, kSets - 2);
}

// D and ε enter as D ε² alone.
TEST(Calibration, SaysWhatTheDataDoNotDetermine) {
  for (int seed = 1; seed <= 4; ++seed) {
    const calibration::Calibration found = calibrated(false, seed, 0.11);
    EXPECT_FALSE(found.parameters[1].determined) << seed;
    ASSERT_EQ(found.best_powers.size(), 2u);
    EXPECT_NEAR(found.best_powers[0] / found.best_powers[1], 0.5, 0.1) << seed;
    // The correlation of R²/D with ε. Replicates reach along the valley as far as the points do,
    // 0.27 in ln ε and 0.54 in ln R²/D, and scatter by 0.2 to 0.3 across: 0.88 to 0.94.
    EXPECT_GT(found.correlation(0, 1), 0.85);
    EXPECT_LT(found.best_deviation, 0.15);
  }
}

// Without other parameters the unit of time alone is found, from one ensemble.
TEST(Calibration, OfTheUnitOfTimeAloneTakesOneEnsemble) {
  const std::vector<calibration::CalibrationPoint> points = {
      {{}, simulate(kEpsilon, true, 40, 77)}};
  std::vector<double> errors, scatter;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const calibration::Calibration found =
        calibration::calibrate(measured(true, seed), {}, points, around(2 * kSeconds));
    errors.push_back(std::fabs(std::log(found.parameters[0].value / kSeconds)));
    scatter.push_back(found.best.scatter_beyond_runs(Quantity::perimeter));
  }
  EXPECT_LT(statistics::quantile(errors, 0.5), 0.15);
  EXPECT_LT(statistics::quantile(scatter, 0.5), 0.05);  // beyond what the data say themselves
}

// The raft fraction is what was measured of it, whatever perimeters and numbers say.
TEST(Calibration, FindsTheFractionThatWasMeasured) {
  constexpr double kFraction = 0.1;  // that of the data
  std::vector<calibration::CalibrationPoint> points;
  for (const double step : {0.25, 0.1})
    for (const auto& ln : calibration::design_around({std::log(1.2 * kFraction)}, step)) {
      points.push_back({ln, simulate(kEpsilon, true, 20, 5)});
      for (History& run : points.back().runs)
        for (double& value : run.of(Quantity::fraction)) value = std::exp(ln[0]);
    }
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const MeasuredVesicles data = measured(true, seed);
    double mean = 0, count = 0;
    for (const auto& vesicle : fractions_of_vesicles(data)) {
      mean += vesicle->mean;
      ++count;
    }
    mean /= count;
    const auto found =
        calibration::calibrate(data, {{"fraction", {0.02, 0.9}}}, points, around(kSeconds));
    EXPECT_NEAR(found.parameters[1].value, mean, 0.02 * mean) << seed;
    EXPECT_TRUE(found.parameters[1].determined) << seed;
  }
}

}  // namespace
}  // namespace traceraft::observations
