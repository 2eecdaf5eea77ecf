#include "verification/assimilation/forecast/gap_patterns.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace traceraft::assimilation {
namespace {

// The number of smooth patterns that are not bound to boundaries, at most. They are half as large.
constexpr Eigen::Index kEverywhere = 16;

Columns monomials(const fem::SurfaceSpace& space, int degree) {
  std::vector<Vec> all;
  for (int total = 0; total <= degree; ++total)
    for (int i = 0; i <= total; ++i)
      for (int j = 0; i + j <= total; ++j) {
        Vec nodal(space.nodes());
        for (int k = 0; k < space.nodes(); ++k) {
          const Point x = space.mesh.position(k);
          nodal[k] = std::pow(x[0], i) * std::pow(x[1], j) * std::pow(x[2], total - i - j);
        }
        all.push_back(nodal.normalized());
      }
  Columns X(space.nodes(), static_cast<Eigen::Index>(all.size()));
  for (std::size_t k = 0; k < all.size(); ++k) X.col(k) = all[k];
  return X;
}

}  // namespace

GapPatterns::GapPatterns(const fem::SurfaceSpace& space, int degree)
    : area_(space.area), mass_(fem::as_eigen(space, space.mass)) {
  const Columns X = monomials(space, degree);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(X.transpose() * (mass_ * X));
  // On a sphere the squares add up to 1, so polynomials repeat themselves.
  const double least = 1e-6 * gram.eigenvalues().maxCoeff();
  const Eigen::Index kept = (gram.eigenvalues().array() > least).count();
  smooth_ = X * gram.eigenvectors().rightCols(kept) *
            (area_ * gram.eigenvalues().tail(kept).cwiseInverse()).cwiseSqrt().asDiagonal();
}

Columns GapPatterns::at(const physics::DoubleWell& well, const Vec& c) const {
  const double half = 0.5 * (well.b - well.a);
  const Vec boundary =
      ((c.array() - well.a) * (well.b - c.array()) / (half * half)).cwiseMax(0).cwiseMin(1);
  const Eigen::Index few = std::min(kEverywhere, smooth_.cols());
  Columns patterns(c.size(), smooth_.cols() + few);
  patterns.leftCols(smooth_.cols()) = boundary.asDiagonal() * smooth_;
  patterns.rightCols(few) = 0.5 * smooth_.leftCols(few);
  const double squares = patterns.cwiseProduct(mass_ * patterns).sum() / area_;
  return patterns / std::sqrt(squares);
}

}  // namespace traceraft::assimilation
