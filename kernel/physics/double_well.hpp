// The free energy density of a homogeneous mixture.
#pragma once

#include <cmath>

namespace traceraft::physics {

// f0(c) = ρ (c − a)² (b − c)². Defaults: ¼ c² (1 − c)².
struct DoubleWell {
  double rho = 0.25;
  double a = 0.0;
  double b = 1.0;

  double energy(double c) const {
    const double p = (c - a) * (b - c);
    return rho * p * p;
  }
  double derivative(double c) const { return 2 * rho * (c - a) * (b - c) * (a + b - 2 * c); }
  double second(double c) const {
    const double d = a + b - 2 * c;
    return 2 * rho * (d * d - 2 * (c - a) * (b - c));
  }

  // ∫ ε|∇c|² per unit length of a flat interface: ∫_a^b √(2 f0) dc = √(2ρ) (b − a)³ / 6.
  double interface_energy() const { return std::sqrt(2 * rho) * std::pow(b - a, 3) / 6; }

  // c(s) = a + (b − a) / (1 + exp(s √(2ρ) (b − a) / ε)), s the distance out of the b phase.
  double profile(double s, double epsilon) const {
    return a + (b - a) / (1 + std::exp(s * std::sqrt(2 * rho) * (b - a) / epsilon));
  }
};

}  // namespace traceraft::physics
