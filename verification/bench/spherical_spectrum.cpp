#include "verification/bench/spherical_spectrum.hpp"

#include <cmath>

#include "kernel/fem/density_load.hpp"

namespace traceraft::bench {
namespace {

// P̄_l^m(cos θ) for l = m … highest, normalised so that ∫ (P̄_l^m)² dΩ = 1 with the factor 1 for m =
// 0 and √2 cos(mφ), √2 sin(mφ) else. Stable forward recursion in l (Numerical Recipes,
// section 6.7).
class Legendre {
 public:
  explicit Legendre(int highest)
      : highest_(highest),
        a_(highest + 1, std::vector<double>(highest + 1, 0)),
        b_(a_),
        sectoral_(highest + 1, std::sqrt(1 / (4 * kPi))) {
    for (int m = 0; m <= highest; ++m) {
      sectoral_[m] = m > 0 ? std::sqrt((2.0 * m + 1) / (2.0 * m)) : sectoral_[m];
      for (int l = m + 1; l <= highest; ++l) {
        a_[m][l] = std::sqrt((4.0 * l * l - 1) / (1.0 * l * l - 1.0 * m * m));
        b_[m][l] =
            std::sqrt(((l - 1.0) * (l - 1.0) - 1.0 * m * m) / (4 * (l - 1.0) * (l - 1.0) - 1));
      }
    }
  }
  // P̄_m^m from P̄_(m−1)^(m−1); before the first there is 1.
  double next_sectoral(int m, double sine, double before) const {
    return sectoral_[m] * (m > 0 ? sine : 1) * before;
  }
  void fill(int m, double cosine, double sectoral, std::vector<double>& p) const {
    p[m] = sectoral;
    double before = 0;
    for (int l = m + 1; l <= highest_; ++l) {
      p[l] = a_[m][l] * (cosine * p[l - 1] - b_[m][l] * before);
      before = p[l - 1];
    }
  }

 private:
  int highest_;
  std::vector<std::vector<double>> a_, b_;
  std::vector<double> sectoral_;
};

}  // namespace

std::vector<double> spherical_spectrum(const fem::SurfaceSpace& space, VecView c, int highest) {
  const mesh::CutSurface& surface = space.surface;
  const Vec values = fem::trace(space, c);
  const Legendre legendre(highest);
  const std::size_t size = static_cast<std::size_t>(highest) + 1;
  // Coefficients of cos(mφ) and sin(mφ), row m, column l.
  std::vector<std::vector<double>> even(size, std::vector<double>(size, 0)), odd = even;
  std::vector<double> p(size);
  const auto add = [&](const Point& x, double mass) {
    const double sine = std::hypot(x[0], x[1]), phi = std::atan2(x[1], x[0]);
    double sectoral = 1;
    for (int m = 0; m <= highest; ++m) {
      sectoral = legendre.next_sectoral(m, sine, sectoral);
      legendre.fill(m, x[2], sectoral, p);
      const double norm = m == 0 ? mass : std::sqrt(2.0) * mass;
      const double along = norm * std::cos(m * phi), across = norm * std::sin(m * phi);
      for (int l = m; l <= highest; ++l) {
        even[m][l] += along * p[l];
        odd[m][l] += across * p[l];
      }
    }
  };
  fem::for_each_quadrature_point(surface, [&](const fem::QuadraturePoint& at) {
    add(at.x.normalized(), at.weight * at.value(surface, values));
  });
  std::vector<double> spectrum(size, 0);
  for (int l = 0; l <= highest; ++l)
    for (int m = 0; m <= l; ++m) spectrum[l] += even[m][l] * even[m][l] + odd[m][l] * odd[m][l];
  return spectrum;
}

double median_degree(const std::vector<double>& spectrum) {
  double half = 0, below = 0;
  for (std::size_t l = 1; l < spectrum.size(); ++l) half += 0.5 * spectrum[l];
  std::size_t l = 1;
  while (l + 1 < spectrum.size() && below + spectrum[l] < half) below += spectrum[l++];
  return static_cast<double>(l) - 0.5 + (half - below) / spectrum[l];
}

}  // namespace traceraft::bench
