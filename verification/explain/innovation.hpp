// What one snapshot says of the forecast of it, and how probable that is.
#pragma once

#include <functional>
#include <vector>

#include "verification/explain/tangent_flow.hpp"

namespace traceraft {

struct Innovation {
  double time;
  Vec forecast;  // c where it was measured
  Vec values;    // measured minus forecast, in units of the noise
  // G: what uncertain directions do to the values: those of the state, with their standard
  // deviations, then patterns that a gap could have (GapPatterns), of size 1.
  Columns directions;
  Eigen::Index state_directions;
  Eigen::MatrixXd gram;         // Gᵀ G, its lower half
  Columns parameters;           // X: derivatives of the forecast by the parameters
  Columns replicates;           // values of noise alone
  double weighted_squares = 0;  // νᵀ S⁻¹ ν, one per value on average
  double model_error;  // size of the state's error that is no noise, per step, in units of c
};

// S = 1 + G D² Gᵀ by Woodbury's formula, D being 1 for the state and `gap_size` for gaps. The
// innovation must outlive it.
class InnovationCovariance {
 public:
  InnovationCovariance(const Innovation& innovation, double gap_size);
  // S⁻¹ X.
  Columns solve(const Columns& X) const;
  double log_determinant() const;
  // D times the mean of the directions' amplitudes, whose prior is standard normal, given X.
  Columns amplitudes(const Columns& X) const;
  // Makes of L, which has a column per direction, a root of the covariance that is left.
  Columns posterior_root(const Columns& L) const;

 private:
  const Columns& G_;
  Vec scale_;
  Eigen::LLT<Eigen::MatrixXd> factors_;  // of 1 + D Gᵀ G D
};

// The size of the model's error that makes an innovation most probable.
double most_probable_error(const Innovation& innovation);

// How much of each column is explained by gaps of the given size, as the square of what has unit
// variance in noise: the model's error is not allowed for.
Vec explained_squares(const Innovation& innovation, double size, const Columns& values);

// Over all values of some innovations.
double root_mean_square(const std::vector<Innovation>& innovations, std::size_t begin,
                        std::size_t end, const std::function<Vec(const Innovation&)>& values);

Columns side_by_side(const Columns& a, const Columns& b);

}  // namespace traceraft
