// Measurements that a model would have given: the looks of data that exist, at vesicles that
// scatter as runs of the model do, with the scatter of a fit and errors like the stated ones.
#pragma once

#include <cstdint>
#include <vector>

#include "verification/likelihood/ensemble_fit.hpp"

namespace traceraft::likelihood {

// Runs whose logarithms are moved by the difference of two curves, `to` − `from`, if there are any:
// runs of another choice of the parameters, to which they are near.
struct ModelRuns {
  const std::vector<observations::History>* runs;
  const RunCurves* from = nullptr;
  const RunCurves* to = nullptr;

  // Weighted mean.
  double logarithm(const Vec& weights, observations::Quantity quantity, double t) const;
};

// Quantities that were not measured are not drawn. Those of a vesicle are zero where it has less
// than kLeastRafts on average. `replicate`: number of the data set.
inline constexpr double kLeastRafts = 0.75;
observations::MeasuredVesicles drawn_vesicles(const observations::MeasuredVesicles& data,
                                              const observations::StatedErrors& errors,
                                              const ModelRuns& model, const EnsembleFit& fit,
                                              std::uint64_t replicate);

// Prior knowledge of the unit is a measurement, too: it is drawn around the unit of the fit.
// The fit ends where it did: with other ends the data of some sets would lie beyond them.
UnitPrior drawn_unit(const EnsembleFit& fit, const UnitPrior& unit, std::uint64_t replicate);

}  // namespace traceraft::likelihood
