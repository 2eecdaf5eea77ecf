#include "kernel/flow/harmonic_forms.hpp"

#include <cmath>
#include <cstdlib>
#include <vector>

#include "kernel/flow/harmonic_transform.hpp"
#include "kernel/flow/legendre.hpp"
#include "kernel/geometry/differences.hpp"

namespace traceraft::flow {
namespace {

// Harmonics need as many rings as their products have degrees; the shape has degrees of its own.
constexpr int kRingsOfTheShape = 48;

// Fejér's first rule for ∫ f(θ) sin θ dθ at θ = (i + ½)π/n.
double fejer_weight(int i, int n) {
  const double theta = (i + 0.5) * kPi / n;
  double sum = 0;
  for (int j = 1; j <= n / 2; ++j) sum += std::cos(2 * j * theta) / (4.0 * j * j - 1);
  return 2 * (1 - 2 * sum) / n;
}

// Integrals are over directions: ∇_Γ u · ∇_Γ v dA = Σ D_a u A_ab D_b v dΩ with a, b = θ, φ. Here D
// = (∂_θ, ∂_φ/sin θ), A = (1 − ν νᵀ)/(n·s), ν = (n·e_θ, n·e_φ), and s is the ray; dA = r²/(n·s) dΩ.
struct Density {
  double mass;
  Eigen::Matrix2d metric;  // A
  double curvature;
};

Density density_at(const geometry::StarSurface& surface, double theta, double phi) {
  const Point s(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)),
      e_theta(std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi), -std::sin(theta)),
      e_phi(-std::sin(phi), std::cos(phi), 0);
  const double r = surface.radius(s);
  const geometry::LevelSetDerivatives at(surface.level_set(), surface.centre() + r * s);
  const Point n = at.normal();
  const double along = n.dot(s);
  const Eigen::Vector2d nu(n.dot(e_theta), n.dot(e_phi));
  return {r * r / along, (Eigen::Matrix2d::Identity() - nu * nu.transpose()) / along,
          at.gaussian_curvature()};
}

// The integrals over one ring, ∫ wave_m wave_m' density dφ, times the weight of the ring.
struct RingIntegrals {
  Eigen::MatrixXd mass;
  std::array<Eigen::MatrixXd, 3> metric, curved;  // θθ, θφ, φφ
};

class Assembly {
 public:
  Assembly(const geometry::StarSurface& surface, int degree)
      : degree_(degree), rings_(2 * (degree + 1) + kRingsOfTheShape) {
    for (int m = 0; m <= degree; ++m) {
      Eigen::MatrixXd value(rings_, degree - m + 1), slope = value, over_sine = value;
      for (int i = 0; i < rings_; ++i) {
        const double theta = (i + 0.5) * kPi / rings_;
        value.row(i) = legendre(degree, m, theta).transpose();
        slope.row(i) = legendre_slopes(degree, m, theta).transpose();
        over_sine.row(i) = m / std::sin(theta) * value.row(i);
      }
      values_.push_back(std::move(value));
      slopes_.push_back(std::move(slope));
      over_sines_.push_back(std::move(over_sine));
    }
    const Eigen::MatrixXd waves = waves_at(columns(), degree);
    for (int i = 0; i < rings_; ++i) integrals_.push_back(ring_integrals(surface, waves, i));
  }

  HarmonicForms forms() const {
    const Eigen::Index size = harmonic_index(degree_, degree_) + 1;
    HarmonicForms result{Eigen::MatrixXd(size, size), Eigen::MatrixXd(size, size),
                         Eigen::MatrixXd(size, size)};
    for (int m = -degree_; m <= degree_; ++m)
      for (int n = -degree_; n <= m; ++n) {
        const auto& left = values_[static_cast<std::size_t>(std::abs(m))];
        const auto& right = values_[static_cast<std::size_t>(std::abs(n))];
        const Vec weight = over_rings(
            [&](const RingIntegrals& ring) { return ring.mass(wave_index(m), wave_index(n)); });
        put(m, n, left.transpose() * weight.asDiagonal() * right, result.mass);
        put(m, n, of_gradients(m, n, &RingIntegrals::metric), result.stiffness);
        put(m, n, of_gradients(m, n, &RingIntegrals::curved), result.curved_stiffness);
      }
    return result;
  }

 private:
  int columns() const { return 2 * rings_; }

  RingIntegrals ring_integrals(const geometry::StarSurface& surface, const Eigen::MatrixXd& waves,
                               int i) const {
    const double theta = (i + 0.5) * kPi / rings_,
                 weight = fejer_weight(i, rings_) * 2 * kPi / columns();
    Vec mass(columns());
    std::array<Vec, 3> metric, curved;
    metric.fill(mass);
    curved.fill(mass);
    for (int j = 0; j < columns(); ++j) {
      const Density at = density_at(surface, theta, 2 * kPi * j / columns());
      mass[j] = weight * at.mass;
      const double entries[] = {at.metric(0, 0), at.metric(0, 1), at.metric(1, 1)};
      for (std::size_t a = 0; a < 3; ++a) {
        metric[a][j] = weight * entries[a];
        curved[a][j] = at.curvature * metric[a][j];
      }
    }
    const auto between_waves = [&](const Vec& density) -> Eigen::MatrixXd {
      return waves.transpose() * density.asDiagonal() * waves;
    };
    RingIntegrals result{between_waves(mass), {}, {}};
    for (std::size_t a = 0; a < 3; ++a) {
      result.metric[a] = between_waves(metric[a]);
      result.curved[a] = between_waves(curved[a]);
    }
    return result;
  }

  template <class OfRing>
  Vec over_rings(const OfRing& of_ring) const {
    Vec result(rings_);
    for (int i = 0; i < rings_; ++i) result[i] = of_ring(integrals_[static_cast<std::size_t>(i)]);
    return result;
  }

  // ∂_φ of the wave m is −m times the wave −m.
  Eigen::MatrixXd of_gradients(int m, int n,
                               std::array<Eigen::MatrixXd, 3> RingIntegrals::*metric) const {
    const auto p = static_cast<std::size_t>(std::abs(m)), q = static_cast<std::size_t>(std::abs(n));
    const double sign_m = m < 0 ? 1 : -1, sign_n = n < 0 ? 1 : -1;
    const auto between = [&](std::size_t part, int first, int second) {
      return over_rings([&](const RingIntegrals& ring) {
        return (ring.*metric)[part](wave_index(first), wave_index(second));
      });
    };
    const Eigen::MatrixXd by_theta = between(0, m, n).asDiagonal() * slopes_[q] +
                                     sign_n * between(1, m, -n).asDiagonal() * over_sines_[q],
                          by_phi = between(1, -m, n).asDiagonal() * slopes_[q] +
                                   sign_n * between(2, -m, -n).asDiagonal() * over_sines_[q];
    return slopes_[p].transpose() * by_theta + sign_m * over_sines_[p].transpose() * by_phi;
  }

  void put(int m, int n, const Eigen::MatrixXd& block, Eigen::MatrixXd& matrix) const {
    for (int l = std::abs(m); l <= degree_; ++l)
      for (int k = std::abs(n); k <= degree_; ++k) {
        const Eigen::Index row = harmonic_index(l, m), column = harmonic_index(k, n);
        matrix(row, column) = matrix(column, row) = block(l - std::abs(m), k - std::abs(n));
      }
  }

  int degree_, rings_;
  std::vector<Eigen::MatrixXd> values_, slopes_, over_sines_;  // of each |m|: rings × degrees
  std::vector<RingIntegrals> integrals_;
};

}  // namespace

HarmonicForms harmonic_forms(const geometry::StarSurface& surface, int degree) {
  return Assembly(surface, degree).forms();
}

}  // namespace traceraft::flow
