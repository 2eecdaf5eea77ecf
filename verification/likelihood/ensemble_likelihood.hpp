// The likelihood of observations under an ensemble as a function of what is fitted, with its
// gradient and Fisher's information.
#pragma once

#include <vector>

#include "kernel/core/types.hpp"
#include "verification/likelihood/ensemble_fit.hpp"

namespace traceraft {

// A free number of a fit: ln of the unit, the amplitude, or ln of a standard deviation.
struct FreeParameter {
  enum class Kind { unit, amplitude, vesicle_scatter, look_scatter };
  Kind kind;
  Quantity quantity = Quantity::perimeter;  // of a scatter

  double get(const EnsembleFit& fit) const;
  void set(double value, EnsembleFit& fit) const;
};

// A deviance around a fit, with an entry per parameter.
struct DevianceExpansion {
  double value;
  Vec gradient;
  Eigen::MatrixXd hessian;  // the expected one: twice Fisher's information
};

class EnsembleLikelihood {
 public:
  // What it is given must outlive it.
  EnsembleLikelihood(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                     const UnitPrior& unit);

  // −2 ln of the likelihood and of the prior, up to a constant.
  double deviance(const EnsembleFit& at) const;
  DevianceExpansion expand(const EnsembleFit& at,
                           const std::vector<FreeParameter>& parameters) const;

 private:
  struct Block {
    const ObservedSeries* series;
    Eigen::MatrixXd correlation;  // of runs, between the times of the looks
  };
  // What looks of a block leave, and their covariance.
  struct Normal {
    Vec residual;
    Eigen::MatrixXd covariance;
  };
  Normal normal(const Block& block, const EnsembleFit& at) const;
  Normal derivative(const Block& block, const EnsembleFit& at,
                    const FreeParameter& parameter) const;

  const EnsembleModel model_;
  const UnitPrior& unit_;
  std::vector<Block> blocks_;
};

}  // namespace traceraft
