// The most probable coefficients of a hypothesis: no longer to first order, but with forecasts by
// the model that has the effects.
#pragma once

#include "verification/explain/field_filter.hpp"

namespace traceraft {

// Root mean squares: of the snapshots that count, and of those that are held out (0: none is).
struct Gaps {
  double train = 0, heldout = 0;
};

struct SnapshotGap {
  std::size_t vesicle, snapshot;
  double gap, expected;  // root mean squares
};

struct Refit {
  Hypothesis hypothesis;
  double pace = 1;
  double deviance = 0;         // −2 ln of the likelihood, at its least
  Eigen::MatrixXd covariance;  // of the coefficients, pace and mesh being free
  double pace_deviation = 0;   // of ln pace
  // Measured minus forecast in units of the noise, and what is to be expected of it if nothing is
  // missing: the noise, and what it leaves unknown of the state.
  Gaps gap, expected;
  std::vector<SnapshotGap> snapshots;  // the same, one by one
  std::string failure;                 // why a forecast failed, if it did: no refit then
};

// Measured minus forecast in units of the noise.
Gaps gaps_of_pass(const FilterResult& pass);
Gaps expected_gaps(const FilterResult& pass);  // if nothing is missing

// Gauss and Newton's method with halved steps, from the coefficients and the pace of `start`, until
// what is left to go is a small part of the standard deviation. Unstable trial models count as
// improbable. Coefficients keep the sign that their effect has.
Refit refit(const FilterProblems& data, const FilterModel& start, const FilterSettings& settings,
            const std::vector<ErrorMaps>& maps);

}  // namespace traceraft
