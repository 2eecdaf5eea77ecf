#include "kernel/flow/fluid_membrane.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/types.hpp"
#include "kernel/flow/legendre.hpp"

namespace traceraft::flow {
namespace {

constexpr int kHighestDegree = 64;

int clamped_degree(double degree, int least) {
  return std::clamp(static_cast<int>(std::min(std::ceil(degree), 1e6)), least, kHighestDegree);
}

}  // namespace

// ⟨|u|²⟩ τ with ⟨ψ_lm²⟩ = 2Θ/(friction τ) and Σ_m |∇Y_lm|² = l (l + 1)(2l + 1)/(4π).
double FluidMembrane::spreading_rate(double half_angle) const {
  const Vec mean = means_over_cap(std::cos(half_angle), kHighestDegree);
  double sum = 0;
  for (int l = 1; l <= kHighestDegree; ++l)
    sum += (2 * l + 1) * l * (l + 1) / friction(l) * mean[l] * mean[l];
  return 2 * thermal * sum / (4 * kPi);
}

double capillary_number(double line_tension, double epsilon, double interface_energy,
                        double membrane_viscosity) {
  return line_tension / (epsilon * interface_energy * membrane_viscosity);
}

int capillary_degree(double epsilon) {
  return clamped_degree(1.6 / epsilon, 16);
}

int brownian_degree(double epsilon) {
  return clamped_degree(0.5 / epsilon, 2);
}

double hold_of(const FluidMembrane& membrane, double epsilon) {
  constexpr double kRadius = 5, kMoved = 0.5;  // of epsilon
  return kMoved * kMoved * epsilon * epsilon /
         membrane.spreading_rate(std::min(kRadius * epsilon, 0.5 * kPi));
}

}  // namespace traceraft::flow
