#include "verification/measure/spherical_spectrum.hpp"

#include <cmath>

#include "kernel/fem/trace.hpp"

namespace traceraft {
namespace {

// P̄_l^m(cos θ) for l = m … highest, normalised so that ∫ (P̄_l^m)² dΩ = 1 with the factor 1 for m =
// 0 and √2 cos(mφ), √2 sin(mφ) else. Stable forward recursion in l (Numerical Recipes,
// section 6.7).
void associated_legendre(double cosine, double sectoral, int m, std::vector<double>& p) {
  const int highest = static_cast<int>(p.size()) - 1;
  p[m] = sectoral;
  if (m < highest) p[m + 1] = cosine * std::sqrt(2.0 * m + 3) * sectoral;
  for (int l = m + 2; l <= highest; ++l) {
    const double a = std::sqrt((4.0 * l * l - 1) / (1.0 * l * l - 1.0 * m * m));
    const double b =
        std::sqrt(((l - 1.0) * (l - 1.0) - 1.0 * m * m) / (4 * (l - 1.0) * (l - 1.0) - 1));
    p[l] = a * (cosine * p[l - 1] - b * p[l - 2]);
  }
}

}  // namespace

std::vector<double> spherical_spectrum(const SurfaceSpace& space, ConstVec c, int highest) {
  const CutSurface& surface = space.surface;
  std::vector<double> weight(surface.points.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const int point : surface.triangles[t]) weight[point] += surface.triangle_area[t] / 3;
  const Vec values = trace(space, c);

  const std::size_t size = static_cast<std::size_t>(highest) + 1;
  // Coefficients of cos(mφ) and sin(mφ), row m, column l.
  std::vector<std::vector<double>> even(size, std::vector<double>(size, 0)), odd = even;
  std::vector<double> p(size);
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Point x = surface.position[i].normalized();
    const double sine = std::hypot(x[0], x[1]), phi = std::atan2(x[1], x[0]);
    const double mass = weight[i] * values[static_cast<Eigen::Index>(i)];
    double sectoral = std::sqrt(1 / (4 * kPi));
    for (int m = 0; m <= highest; ++m) {
      if (m > 0) sectoral *= std::sqrt((2.0 * m + 1) / (2.0 * m)) * sine;
      associated_legendre(x[2], sectoral, m, p);
      const double norm = m == 0 ? mass : std::sqrt(2.0) * mass;
      const double along = norm * std::cos(m * phi), across = norm * std::sin(m * phi);
      for (int l = m; l <= highest; ++l) {
        even[m][l] += along * p[l];
        odd[m][l] += across * p[l];
      }
    }
  }
  std::vector<double> spectrum(size, 0);
  for (int l = 0; l <= highest; ++l)
    for (int m = 0; m <= l; ++m) spectrum[l] += even[m][l] * even[m][l] + odd[m][l] * odd[m][l];
  return spectrum;
}

double mean_degree(const std::vector<double>& spectrum) {
  double weighted = 0, total = 0;
  for (std::size_t l = 1; l < spectrum.size(); ++l) {
    weighted += static_cast<double>(l) * spectrum[l];
    total += spectrum[l];
  }
  return weighted / total;
}

}  // namespace traceraft
