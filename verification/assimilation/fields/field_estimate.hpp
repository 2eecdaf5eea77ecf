// A field on Γ from noisy values at scattered points, and how well they determine it.
#pragma once

#include <cstdint>
#include <vector>

#include "verification/assimilation/fields/point_trace.hpp"

namespace traceraft::assimilation {

struct NoisyValues {
  PointTrace trace;  // where they were measured
  Vec values;
  Vec deviation;  // relative to each other; the size of the noise is estimated
};

// The distribution of fields before one is measured: a mean plus a Gaussian random field, the
// solution of (1/length² − Δ) c = white noise (Lindgren, Rue, Lindström 2011).
struct FieldPrior {
  double length,  // of the field's correlations
      smoothing;  // precision of the field, in units of that of one measurement
};

// How the error of an estimate is wanted: its directions by importance for what is smooth over
// `length`, and random draws.
struct ErrorRequest {
  double length = 0;
  int rank = 0, draws = 0;
  std::uint64_t stream = 0;  // of random numbers
};

struct FieldEstimate {
  Vec field;               // nodal
  FieldPrior prior;        // that makes the values most probable
  double noise;            // standard deviation of the measurements, in units of their `deviation`
  Eigen::MatrixXd errors;  // n × rank: their product with its transpose is the covariance of the
                           // error, as far as it has so many directions that matter
  Eigen::MatrixXd draws;   // errors drawn at random, of all directions, a column for each
};

// The prior and the noise maximise the marginal likelihood of the values; nobody has to know them.
// Serial spaces. Throws std::runtime_error if the field cannot be estimated.
FieldEstimate estimate_field(const fem::SurfaceSpace& space, const NoisyValues& measured,
                             const ErrorRequest& wanted);
// The same with a prior that is known.
FieldEstimate estimate_field(const fem::SurfaceSpace& space, const NoisyValues& measured,
                             const FieldPrior& prior, const ErrorRequest& wanted);

// Orthonormalises the columns of X in the inner product xᵀ A y, by the eigenvectors of their Gram
// matrix, largest first; directions below 1e-10 of the largest are dropped, and all beyond `most`.
// X is left with the scaled eigenvectors: X_new X_newᵀ ≈ X Xᵀ.
void compress(const Eigen::SparseMatrix<double>& A, Eigen::MatrixXd& X, int most);

}  // namespace traceraft::assimilation
