// The parameters under which measurements are most probable: the unit of time, the scatter of
// measuring, and those that cost simulations, all at once.
#pragma once

#include <vector>

#include "verification/calibration/run_emulator.hpp"
#include "verification/likelihood/ensemble_fit.hpp"

namespace traceraft {

// Where parameters are looked for.
struct Box {
  std::vector<double> lower, upper;
};

// The observations that count, and what is known of the unit of time.
struct Evidence {
  std::vector<ObservedSeries> observations;
  const UnitPrior& unit;

  // The unit of time and the scatter that make the observations most probable.
  EnsembleFit fit(const RunCurves& runs) const { return fit_ensemble(observations, {&runs}, unit); }
  EnsembleFit fit(const RunCurves& runs, const EnsembleFit& near) const {
    return fit_ensemble(observations, {&runs}, unit, near);
  }
};

struct JointFit {
  std::vector<double> ln_parameters;
  EnsembleFit fit;
  std::vector<double> deviations;  // of ln_parameters, by Fisher's information
};

// The best one that is found from the starts.
JointFit fit_jointly(const Evidence& evidence, const RunEmulator& runs, const Box& box,
                     const std::vector<JointFit>& starts);

}  // namespace traceraft
