// What one snapshot says of the forecast of it, and how probable that is.
#pragma once

#include <functional>
#include <vector>

#include "verification/assimilation/fields/noise_correlation.hpp"
#include "verification/assimilation/forecast/tangent_flow.hpp"

namespace traceraft::assimilation {

// Parameters: ln D first, second what extrapolation to finer meshes gets wrong of its last part,
// then the coefficients of the hypothesis and those of the screened candidates.
inline constexpr int kDiffusionRatio = 0, kMeshError = 1, kFirstParameter = 2;

struct Innovation {
  std::size_t vesicle, snapshot;  // of the data
  bool held_out;                  // it counts for nothing, but between members of a class
  Vec forecast;                   // c where it was measured
  Vec noise;                      // standard deviation of each value, in c
  // What values, directions, parameters and replicates are divided by beside that, so that noise is
  // white in all of them; nothing where it is anyway.
  WhiteningPtr whitening;
  Vec values;  // measured minus forecast, in units of the noise
  // G: what uncertain directions do to the values: those of the state, with their standard
  // deviations, then patterns that a gap could have (GapPatterns), of size 1.
  Columns directions;
  Eigen::Index state_directions;
  // The first of them are what the first snapshot's scale and zero make of the forecast.
  Eigen::Index first_frame = 0;
  Eigen::MatrixXd gram;         // Gᵀ G, its lower half
  Columns parameters;           // X: derivatives of the forecast by the parameters
  Columns replicates;           // values of noise alone
  double weighted_squares = 0;  // νᵀ S⁻¹ ν, one per value on average
  double expected_squares = 0;  // of the gap in c, by noise and what it leaves unknown of c
  // Most probable turns about the three axes, scale and zero of the values, and their blur if
  // images have one, in their standard deviations; `gap`: the values without what these, and the
  // first snapshot's, make of them, each at its point.
  Vec frame, gap;
  double model_error;  // size of the state's error that is no noise, per step, of the distance of
                       // the phases
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

// From units of white noise to those of the noise of each value at its point, and back.
Columns at_points(const Innovation& innovation, const Columns& X);
Columns whitened(const Innovation& innovation, const Columns& X);

// The replicates without what the first snapshot's scale and zero make of them, at the points.
Columns gaps_of_replicates(const Innovation& innovation);

// The size of the model's error that makes an innovation most probable.
double most_probable_error(const Innovation& innovation);

// What gaps of the given size explain of each column, the model's error not being allowed for: one
// row per pattern, whose sum of squares has the distribution of χ² if the column is noise and gaps
// are larger than what noise leaves unknown of them.
Columns explained_parts(const Innovation& innovation, double size, const Columns& values);

// Over all values of those innovations that are held out, or not; `squares`: their sum in one.
double root_mean_square(const std::vector<Innovation>& innovations, bool held_out,
                        const std::function<double(const Innovation&)>& squares);

Columns side_by_side(const Columns& a, const Columns& b);

}  // namespace traceraft::assimilation
