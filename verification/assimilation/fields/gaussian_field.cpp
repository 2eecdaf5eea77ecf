#include "verification/assimilation/fields/gaussian_field.hpp"

#include <Eigen/Dense>

#include "kernel/core/random.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::assimilation {

FieldMatrices::FieldMatrices(const fem::SurfaceSpace& space)
    : mass(fem::as_eigen(space, space.stabilised_mass)),
      trace_mass(fem::as_eigen(space, space.mass)),
      stiffness(stiffness_along_normals(space)) {}

GaussianField::GaussianField(const fem::SurfaceSpace& space, const FieldPrior& prior)
    : matrices_(space),
      root_((matrices_.mass.diagonal() / prior.smoothing).cwiseSqrt()),
      mass_factors_(matrices_.mass),
      factors_(
          fem::EigenMatrix(matrices_.mass / (prior.length * prior.length) + matrices_.stiffness)) {}

Eigen::MatrixXd GaussianField::covariance_times(const Eigen::MatrixXd& X) const {
  return factors_.solve(root_.cwiseAbs2().asDiagonal() * factors_.solve(X));
}

Eigen::MatrixXd GaussianField::root_at(const PointTrace& trace) const {
  return root_.asDiagonal() * factors_.solve(Eigen::MatrixXd(trace.transpose()));
}

Eigen::MatrixXd GaussianField::draws(int count, std::uint64_t stream) const {
  Eigen::MatrixXd z(root_.size(), count);
  for (Eigen::Index i = 0; i < z.size(); ++i)
    z.data()[i] =
        normal_random(statistics::fixed_seed::field_draws, stream, static_cast<std::uint64_t>(i));
  return factors_.solve(root_.asDiagonal() * z);
}

Eigen::MatrixXd GaussianField::projected(const Eigen::MatrixXd& X) const {
  return mass_factors_.solve(matrices_.trace_mass * X);
}

Eigen::MatrixXd important_directions(const FieldMatrices& matrices,
                                     const CovarianceTimes& covariance, double length, int rank) {
  constexpr int kIterations = 4, kExtra = 16;
  const fem::EigenMatrix smoother = matrices.mass + length * length * matrices.stiffness;
  const suitesparse::SparseCholesky smoothing(smoother);
  const auto weighted = [&](const Eigen::MatrixXd& X) -> Eigen::MatrixXd {
    return matrices.mass *
           smoothing.solve(matrices.trace_mass * smoothing.solve(matrices.mass * X));
  };
  const Eigen::Index n = matrices.mass.rows();
  Eigen::MatrixXd X(n, std::min<Eigen::Index>(rank + kExtra, n));
  for (Eigen::Index i = 0; i < X.size(); ++i)
    X.data()[i] =
        uniform_random(statistics::fixed_seed::test_vectors, 0, static_cast<std::uint64_t>(i)) -
        0.5;
  for (int k = 0; k < kIterations; ++k) {
    X = covariance(weighted(X)).eval();
    const Eigen::LLT<Eigen::MatrixXd> gram(X.transpose() * weighted(X));
    X = gram.matrixU().solve<Eigen::OnTheRight>(X).eval();
  }
  const Eigen::MatrixXd WX = weighted(X);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(WX.transpose() * covariance(WX));
  const Eigen::Index kept = std::min<Eigen::Index>(rank, X.cols());
  return X * ritz.eigenvectors().rightCols(kept) *
         ritz.eigenvalues().tail(kept).cwiseMax(0).cwiseSqrt().asDiagonal();
}

}  // namespace traceraft::assimilation
