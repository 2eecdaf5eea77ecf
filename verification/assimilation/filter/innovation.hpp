// The innovation of one snapshot: how it differs from its forecast, and how probable that is.
#pragma once

#include <functional>
#include <vector>

#include "verification/assimilation/fields/noise_correlation.hpp"
#include "verification/assimilation/forecast/tangent_flow.hpp"

namespace traceraft::assimilation {

// Places of the parameters: ln D first, second what extrapolation to finer meshes gets wrong of its
// last part, then the coefficients of the hypothesis and those of the screened candidates.
inline constexpr int kDiffusionRatio = 0, kMeshError = 1, kFirstParameter = 2;

// The part of the values that a random effect adds at the variance 1: values × noises, in units of
// the noise.
struct RandomValues {
  Eigen::Index parameter;  // the place of the variance among the parameters
  double variance;         // that the state's directions have it with
  Columns values;
};

struct Innovation {
  std::size_t vesicle, snapshot;  // of the data
  bool held_out;                  // it counts for nothing, but between members of a class
  Vec forecast;                   // c at the points of the values
  Vec noise;                      // standard deviation of each value, in c
  // The factor of the noise's correlations. Values, directions, parameters and replicates are
  // divided by it after `noise`, so that noise is white in them. Nothing where it is white anyway.
  WhiteningPtr whitening;
  Vec values;  // ν: measured minus forecast, in units of the noise
  // G, values × directions: what uncertain directions do to the values. Those of the state come
  // first, with their standard deviations. Patterns that a gap could have follow (GapPatterns), of
  // size 1.
  Columns directions;
  Eigen::Index state_directions;  // number of the directions of the state
  // Number of the first directions that are what the first snapshot's scale and zero make of the
  // forecast.
  Eigen::Index first_frame = 0;
  Eigen::MatrixXd gram;  // Gᵀ G, directions × directions, its lower half
  Columns parameters;    // X, values × parameters: derivatives of the forecast
  Columns replicates;    // values × replicates: values of noise alone
  std::vector<RandomValues> random = {};
  double weighted_squares = 0;  // νᵀ S⁻¹ ν, one per value on average
  double expected_squares = 0;  // of the gap in c, by noise and what it leaves unknown of c
  double random_squares = 0;    // by random effects, likewise, which `expected_squares` includes
  // `frame`: most probable turns about the three axes, scale and zero of the values, and their blur
  // if images have one, each in its standard deviations. `gap`: the values without what `frame`,
  // and the first snapshot's scale and zero, make of them, each at its point, in units of its
  // noise.
  Vec frame, gap;
  // Size of the state's error that is no noise, per step, in units of the distance of the phases.
  double model_error;
};

// S = 1 + G D² Gᵀ by Woodbury's formula, D being 1 for the state and `gap_size` for gaps. The
// innovation must outlive it.
class InnovationCovariance {
 public:
  InnovationCovariance(const Innovation& innovation, double gap_size);
  // S⁻¹ X, for X of values × columns.
  Columns solve(const Columns& X) const;
  double log_determinant() const;
  // Directions × columns: D times the mean of the directions' amplitudes, whose prior is standard
  // normal, given X.
  Columns amplitudes(const Columns& X) const;
  // A root of the covariance that is left of a state which the directions change by the columns of
  // L.
  Columns posterior_root(const Columns& L) const;

 private:
  const Columns& G_;
  Vec scale_;
  Eigen::LLT<Eigen::MatrixXd> factors_;  // of 1 + D Gᵀ G D
};

// at_points: X, values × columns, from units of white noise to those of the noise of each value at
// its point. whitened: the way back.
Columns at_points(const Innovation& innovation, const Columns& X);
Columns whitened(const Innovation& innovation, const Columns& X);

// The replicates without what the first snapshot's scale and zero make of them, at the points.
Columns gaps_of_replicates(const Innovation& innovation);

// The size of the model's error that makes an innovation most probable.
double most_probable_error(const Innovation& innovation);

// The parts of each column of `values` that gaps of the given size explain, patterns × columns. The
// model's error is not allowed for. The sum of squares of a column has the distribution of χ² if
// the column is noise and gaps are larger than what noise leaves unknown of them.
Columns explained_parts(const Innovation& innovation, double size, const Columns& values);

// The root mean square over all values of those innovations that are held out, or of the others.
// `squares`: the sum of the squares in one of them.
double root_mean_square(const std::vector<Innovation>& innovations, bool held_out,
                        const std::function<double(const Innovation&)>& squares);

Columns side_by_side(const Columns& a, const Columns& b);

}  // namespace traceraft::assimilation
