// The parameters under which measurements are most probable: the unit of time, the scatter of
// measuring, and those that cost simulations, all at once.
#pragma once

#include <vector>

#include "verification/calibration/run_emulator.hpp"
#include "verification/likelihood/ensemble_fit.hpp"

namespace traceraft::calibration {

// Where parameters are looked for.
struct Box {
  std::vector<double> lower, upper;
};

// The observations that count, and what is known of the unit of time.
struct Evidence {
  std::vector<likelihood::ObservedSeries> observations;
  const likelihood::UnitPrior& unit;

  // The unit of time and the scatter that make the observations most probable.
  likelihood::EnsembleFit fit(const likelihood::RunCurves& runs) const {
    return likelihood::fit_ensemble(observations, {&runs}, unit);
  }
  likelihood::EnsembleFit fit(const likelihood::RunCurves& runs,
                              const likelihood::EnsembleFit& near) const {
    return likelihood::fit_ensemble(observations, {&runs}, unit, near);
  }
};

struct JointFit {
  std::vector<double> ln_parameters;
  likelihood::EnsembleFit fit;
  std::vector<double> deviations;  // of ln_parameters, by Fisher's information
};

// The best one that is found from the starts.
JointFit fit_jointly(const Evidence& evidence, const RunEmulator& runs, const Box& box,
                     const std::vector<JointFit>& starts);

}  // namespace traceraft::calibration
