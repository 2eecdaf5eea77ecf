// The Gaussian random field of FieldPrior on a mesh, by its covariance.
#pragma once

#include <functional>

#include "backends/suitesparse/sparse_cholesky.hpp"
#include "verification/assimilation/fields/field_estimate.hpp"
#include "verification/assimilation/fields/stiffness_along_normals.hpp"

namespace traceraft::assimilation {

struct FieldMatrices {
  fem::EigenMatrix mass, trace_mass, stiffness;  // M̃, M and A
  explicit FieldMatrices(const fem::SurfaceSpace& space);
};

// Σ = B⁻¹ D B⁻¹ / smoothing with B = M̃/length² + A and D the diagonal of M̃: mean 0, columns are
// nodal fields.
class GaussianField {
 public:
  // Throws std::runtime_error for a prior that is none.
  GaussianField(const fem::SurfaceSpace& space, const FieldPrior& prior);

  Eigen::MatrixXd covariance_times(const Eigen::MatrixXd& X) const;
  // R with Rᵀ R = T Σ Tᵀ.
  Eigen::MatrixXd root_at(const PointTrace& trace) const;
  Eigen::MatrixXd draws(int count, std::uint64_t stream) const;
  // M̃ Y = M X, as initial data of a run: off the surface nothing is known.
  Eigen::MatrixXd projected(const Eigen::MatrixXd& X) const;

  const FieldMatrices& matrices() const { return matrices_; }

 private:
  FieldMatrices matrices_;
  Vec root_;  // of D over the smoothing
  suitesparse::SparseCholesky mass_factors_, factors_;
};

using CovarianceTimes = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& X)>;

// The directions of a covariance Σ that matter most for parts of the field that are smooth over
// `length`: eigenvectors of Σ W with W = Tᵀ M T and T = (1 − length² Δ)⁻¹, by subspace iteration,
// scaled so that their product with its transpose is Σ as far as it has so many of them. Without W
// they would be waves that nothing measures and that the flow damps at once.
Eigen::MatrixXd important_directions(const FieldMatrices& matrices,
                                     const CovarianceTimes& covariance, double length, int rank);

}  // namespace traceraft::assimilation
