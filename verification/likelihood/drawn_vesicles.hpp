// Measurements that a model would have given: the looks of data that exist, at vesicles which are runs
// of the model, with the scatter of a fit and errors like the stated ones.
#pragma once

#include <cstdint>
#include <vector>

#include "verification/likelihood/ensemble_fit.hpp"

namespace traceraft {

// Runs whose logarithms are moved by the difference of two curves, `to` − `from`, if there are any:
// runs of another choice of the parameters, to which they are near.
struct ModelRuns {
  const std::vector<History>* runs;
  const RunCurves* from = nullptr;
  const RunCurves* to = nullptr;

  const History& run(std::size_t k) const { return (*runs)[k]; }
  double logarithm(std::size_t k, Quantity quantity, double t) const;
};

// Each vesicle is one of the runs, drawn at random. Quantities that were not measured are not drawn;
// those of a vesicle without rafts are zero. `replicate`: number of the data set.
MeasuredVesicles drawn_vesicles(const MeasuredVesicles& data, const StatedErrors& errors,
                                const ModelRuns& model, const EnsembleFit& fit,
                                std::uint64_t replicate);

// What is known of the unit before is a measurement, too: it is drawn around the unit of the fit.
// The fit ends where it did: with other ends the data of some sets would lie beyond them.
UnitPrior drawn_unit(const EnsembleFit& fit, const UnitPrior& unit, std::uint64_t replicate);

}  // namespace traceraft
