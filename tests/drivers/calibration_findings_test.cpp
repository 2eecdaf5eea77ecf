// The words of a calibration about what it found.
#include "drivers/calibrate/calibration_findings.hpp"

#include <gtest/gtest.h>

namespace traceraft {
namespace {

using Reasons = std::vector<std::string>;

// R²/D and ε, of which the data know D ε² to 7 %.
calibration::Calibration calibrated() {
  calibration::Calibration result;
  result.parameters = {{"seconds_per_unit", 0.02, {0.016, 0.025}, true, true},
                       {"epsilon", 0.2, {0.18, 0.22}, true, true}};
  result.best_powers = {0.5, 1};
  result.best_deviation = 0.07;
  result.at_bound = 0;
  result.unit_at_bound = false;
  return result;
}

Reasons reasons(const calibration::Calibration& result, std::size_t k) {
  return calibrate::why_undetermined(result.parameters[k], result);
}

TEST(CalibrationFindings, SayWhatTheDataKnowBest) {
  calibration::Calibration result = calibrated();
  EXPECT_EQ(calibrate::best_known(result), "mobility^0.50 * epsilon to 7 % (one standard error)");
  result.best_powers = {0.05, 1};
  EXPECT_EQ(calibrate::best_known(result), "epsilon to 7 % (one standard error)");
}

// Known no better than what was looked at, whichever parameter it is.
TEST(CalibrationFindings, DoNotKnowWhatReachesTheEnd) {
  for (const std::size_t k : {0, 1}) {
    calibration::Calibration result = calibrated();
    result.parameters[k].within = false;
    EXPECT_EQ(calibrate::best_known(result), "") << k;
  }
  calibration::Calibration result = calibrated();
  calibration::mark_unconverged(result);
  EXPECT_EQ(calibrate::best_known(result), "");
}

TEST(CalibrationFindings, SayAllReasonsOnce) {
  calibration::Calibration result = calibrated();
  EXPECT_TRUE(reasons(result, 0).empty());
  result.unit_at_bound = true;  // as calibrate() has it
  for (calibration::CalibratedParameter& p : result.parameters) p.determined = false;
  result.parameters[0].within = false;
  result.parameters[0].interval = {0.01, 0.03};
  EXPECT_EQ(reasons(result, 0), (Reasons{"D lies at the end of the range searched",
                                         "its interval spans a factor of 3"}));
  EXPECT_EQ(reasons(result, 1), Reasons{"D lies at the end of the range searched"});
  result.unit_at_bound = false;
  result.parameters[1].within = false;
  EXPECT_EQ(reasons(result, 0), (Reasons{"its interval reaches the end of the range searched",
                                         "its interval spans a factor of 3"}));
  EXPECT_EQ(reasons(result, 1), Reasons{"its interval reaches the end of what was simulated"});
  calibration::mark_unconverged(result);
  EXPECT_EQ(reasons(result, 1), (Reasons{"the search did not converge",
                                         "its interval reaches the end of what was simulated"}));
}

}  // namespace
}  // namespace traceraft
