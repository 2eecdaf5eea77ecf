// The likelihood of observations under an ensemble, as a function that is cheap to evaluate many
// times: what does not depend on the fit is computed once.
#pragma once

#include <vector>

#include "verification/likelihood/ensemble_fit.hpp"

namespace traceraft {

class EnsembleLikelihood {
 public:
  // What it is given must outlive it.
  EnsembleLikelihood(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                     const UnitPrior& unit);

  // −2 ln of the likelihood at the unit, amplitude and scatter of `at`, and of the prior.
  double deviance(const EnsembleFit& at) const;

 private:
  struct Block {
    const ObservedSeries* series;
    std::vector<double> correlation;  // of runs, the lower triangle by rows
  };
  // Adds Σ r² of the whitened residuals and the diagonal of the Cholesky factor.
  struct Sums;
  void add(const Block& block, const EnsembleFit& at, Sums& sums) const;

  const EnsembleModel model_;
  const UnitPrior& unit_;
  std::vector<Block> blocks_;
  std::size_t most_looks_ = 0;  // of a block
};

}  // namespace traceraft
