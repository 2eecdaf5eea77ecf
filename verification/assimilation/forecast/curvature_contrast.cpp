#include "verification/assimilation/forecast/curvature_contrast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace traceraft::assimilation {
namespace {

// The step of differences, in R: roundoff and their own error are equal at about that.
constexpr double kStep = 1e-3;

// 2 H = div (∇φ/|∇φ|) = (tr B − nᵀ B n)/|∇φ| with B = ∇²φ and n = ∇φ/|∇φ|.
double mean_curvature(const geometry::LevelSet& surface, const Point& x) {
  const auto phi = [&](const Point& offset) { return surface.value(x + kStep * offset); };
  const double centre = phi(Point::Zero());
  Point gradient;
  Eigen::Matrix3d B;
  for (int i = 0; i < 3; ++i) {
    const Point a = Point::Unit(i);
    gradient[i] = (phi(a) - phi(-a)) / (2 * kStep);
    B(i, i) = (phi(a) - 2 * centre + phi(-a)) / (kStep * kStep);
    for (int j = 0; j < i; ++j) {
      const Point b = Point::Unit(j);
      B(i, j) = B(j, i) =
          (phi(a + b) - phi(a - b) - phi(b - a) + phi(-a - b)) / (4 * kStep * kStep);
    }
  }
  const Point n = gradient.normalized();
  return (B.trace() - n.dot(B * n)) / (2 * gradient.norm());
}

}  // namespace

double curvature_contrast(const geometry::LevelSet& surface, const std::vector<Point>& places) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const Point& x : places) {
    const double H = mean_curvature(surface, x);
    least = std::min(least, H);
    most = std::max(most, H);
  }
  return (most - least) / std::max(std::fabs(least), std::fabs(most));
}

}  // namespace traceraft::assimilation
