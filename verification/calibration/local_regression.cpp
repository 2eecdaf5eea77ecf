#include "verification/calibration/local_regression.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/core/types.hpp"

namespace traceraft::calibration {
namespace {

// However far away, a point decides where nothing else does.
constexpr double kLeastWeight = 1e-6;

// 1, x_i, x_i x_j.
Vec monomials(const Vec& x) {
  const auto p = static_cast<int>(x.size());
  Vec values(points_of_parabola(p));
  int k = 0;
  values[k++] = 1;
  for (int i = 0; i < p; ++i) values[k++] = x[i];
  for (int i = 0; i < p; ++i)
    for (int j = i; j < p; ++j) values[k++] = x[i] * x[j];
  return values;
}

}  // namespace

std::vector<double> regression_weights(const std::vector<std::vector<double>>& points,
                                       const std::vector<double>& at, double width) {
  const auto variables = static_cast<int>(at.size());
  const auto count = static_cast<Eigen::Index>(points.size());
  if (count < points_of_parabola(variables))
    throw std::invalid_argument("too few points for a parabola");
  const Eigen::Map<const Vec> centre(at.data(), variables);
  std::vector<Vec> offsets;
  double nearest = HUGE_VAL;
  for (const std::vector<double>& point : points) {
    offsets.push_back((Eigen::Map<const Vec>(point.data(), variables) - centre) / width);
    nearest = std::min(nearest, offsets.back().squaredNorm());
  }
  Eigen::MatrixXd matrix(points_of_parabola(variables), count);
  Vec root(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Vec& offset = offsets[static_cast<std::size_t>(k)];
    const double weight = std::exp(-0.5 * (offset.squaredNorm() - nearest));
    root[k] = std::sqrt(std::max(weight, kLeastWeight));
    matrix.col(k) = root[k] * monomials(offset);
  }
  // The parabola's value at the centre is its first coefficient: the shortest z with matrix z = e₁.
  const Vec z = matrix.completeOrthogonalDecomposition().solve(Vec::Unit(matrix.rows(), 0));
  const Vec weights = root.cwiseProduct(z);
  return {weights.data(), weights.data() + weights.size()};
}

}  // namespace traceraft::calibration
