// The curves of a model with any amount of an effect, from ensembles with some amounts of it.
#pragma once

#include <vector>

#include "verification/likelihood/run_curves.hpp"

namespace traceraft::likelihood {

// The largest amplitude of an effect that was simulated at one strength.
inline constexpr double kLargestAmplitude = 2;

// The amplitude 0 is the base, and k the k-th level: the effect at its k-th strength. Logarithms
// are linear in the amplitude if there is one level, also beyond it. If there are more, they are
// cubic between levels, with a continuous derivative (Catmull and Rom, "A class of local
// interpolating splines", 1974). The scatter of runs is a mean over the nearest levels: from few
// runs it is known badly, and a fit would choose the level at which it happens to fit. One level
// has the scatter of the base.
class EnsembleModel {
 public:
  // All curves must outlive it and have the same times. `two_sided`: may the amplitude of a single
  // level be negative? No levels: there is no effect.
  EnsembleModel(const RunCurves* base, std::vector<const RunCurves*> levels = {},
                bool two_sided = true);

  bool has_effect() const { return curves_.size() > 1; }
  bool has_several_levels() const { return curves_.size() > 2; }
  double least_amplitude() const;
  double largest_amplitude() const;
  const RunCurves& base() const { return *curves_.front(); }
  RunCurves at(double amplitude) const;
  // Derivatives of the mean and of the variance by the amplitude.
  RunCurves by_amplitude(double amplitude) const;

 private:
  std::vector<const RunCurves*> curves_;  // the base first
  bool two_sided_;
};

}  // namespace traceraft::likelihood
