// The likelihood of observations under an ensemble as a function of what is fitted, with its
// gradient and Fisher's information.
#pragma once

#include <vector>

#include "kernel/core/types.hpp"
#include "verification/likelihood/ensemble_fit.hpp"
#include "verification/likelihood/scoring.hpp"

namespace traceraft::likelihood {

// A free number of a fit: ln of the unit, the amplitude, the variance of a scatter, or another
// number on which the mean curves depend. Near zero a likelihood is smooth in a variance, but flat
// in its logarithm.
struct FreeParameter {
  enum class Kind { unit, amplitude, vesicle_scatter, look_scatter, curve };
  Kind kind;
  observations::Quantity quantity = observations::Quantity::perimeter;  // of a scatter
  const RunCurves* derivative = nullptr;  // of a curve: its mean is that of the mean curves

  bool scatters() const { return kind == Kind::vesicle_scatter || kind == Kind::look_scatter; }
  // Not of a curve.
  double get(const EnsembleFit& fit) const;
  void set(double value, EnsembleFit& fit) const;
};

class EnsembleLikelihood {
 public:
  // Blocks and model must outlive it.
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
  // Per look of a block: what is left of the value, the standard deviation of runs, and the
  // variance of the look by itself.
  struct Looks {
    Vec residual, run, own;
  };
  // The model with the amplitude of a fit, and its derivative by that.
  struct Place {
    const EnsembleFit& fit;
    RunCurves curves, by_amplitude;
  };
  Looks looks(const Block& block, const EnsembleFit& fit, const RunCurves& curves) const;
  // Derivatives by a parameter that is no scatter.
  Looks derivative(const Block& block, const Place& at, const FreeParameter& parameter) const;
  Eigen::MatrixXd covariance(const Block& block, const Looks& looks, const EnsembleFit& at) const;
  void add_block(const Block& block, const Place& at, const std::vector<FreeParameter>& parameters,
                 DevianceExpansion& sum) const;

  const EnsembleModel model_;
  const UnitPrior& unit_;
  std::vector<Block> blocks_;
};

// The free parameters of every fit of observations, with bounds: the unit, the amplitude of an
// effect if there is one, and the scatter of each quantity that was observed.
struct FreeParameters {
  std::vector<FreeParameter> all;
  Vec lower, upper;

  FreeParameters(const std::vector<ObservedSeries>& blocks, const EnsembleModel& model,
                 const UnitPrior& unit);
  Vec get(const EnsembleFit& fit) const;
  // `values`: those of this, first.
  void set(const Vec& values, EnsembleFit& fit) const;
};

}  // namespace traceraft::likelihood
