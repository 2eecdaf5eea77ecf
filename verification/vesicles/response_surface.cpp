#include "verification/vesicles/response_surface.hpp"

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

#include "backends/nlopt/minimise.hpp"

namespace traceraft {
namespace {

// 1, x_i, x_i x_j.
Vec monomials(const std::vector<double>& x) {
  const int p = static_cast<int>(x.size());
  Vec values(points_of_surface(p));
  int k = 0;
  values[k++] = 1;
  for (int i = 0; i < p; ++i) values[k++] = x[i];
  for (int i = 0; i < p; ++i)
    for (int j = i; j < p; ++j) values[k++] = x[i] * x[j];
  return values;
}

}  // namespace

ResponseSurface::ResponseSurface(const std::vector<std::vector<double>>& x,
                                 const std::vector<double>& values,
                                 const std::vector<double>& weights)
    : variables_(static_cast<int>(x.front().size())) {
  const auto count = static_cast<Eigen::Index>(x.size());
  if (count < points_of_surface(variables_))
    throw std::invalid_argument("too few points for a parabola");
  Eigen::MatrixXd matrix(count, points_of_surface(variables_));
  Vec right(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double root = std::sqrt(weights[k]);
    matrix.row(i) = root * monomials(x[k]).transpose();
    right[i] = root * values[k];
  }
  coefficients_ = matrix.colPivHouseholderQr().solve(right);
}

double ResponseSurface::at(const std::vector<double>& x) const {
  return coefficients_.dot(monomials(x));
}

std::vector<double> ResponseSurface::minimiser(const std::vector<double>& lower,
                                               const std::vector<double>& upper) const {
  Minimum best{{}, HUGE_VAL, 0, false};
  // A parabola that opens downwards has its minimum at a corner.
  for (int corner = 0; corner <= 1 << variables_; ++corner) {
    std::vector<double> start, step;
    for (int i = 0; i < variables_; ++i) {
      const double share = corner == 1 << variables_ ? 0.5 : (corner >> i & 1 ? 0.99 : 0.01);
      start.push_back(lower[i] + share * (upper[i] - lower[i]));
      step.push_back(0.1 * (upper[i] - lower[i]));
    }
    const Minimum found =
        minimise({[&](const std::vector<double>& x) { return at(x); }, start, lower, upper, step});
    if (found.value < best.value) best = found;
  }
  return best.x;
}

}  // namespace traceraft
