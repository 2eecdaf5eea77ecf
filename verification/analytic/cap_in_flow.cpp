#include "verification/analytic/cap_in_flow.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/types.hpp"
#include "kernel/physics/double_well.hpp"

namespace traceraft::analytic {
namespace {

// P̃_lm with 2π ∫_{-1}^{1} P̃_lm² = 1, but for its sign.
double legendre(int l, int m, double angle) {
  return std::sph_legendre(static_cast<unsigned>(l), static_cast<unsigned>(m), angle);
}

}  // namespace

double relaxation_rate(const flow::FluidMembrane& membrane, double epsilon, double angle, int m) {
  constexpr int kDegrees = 2000;  // terms fall as l⁻⁴
  double sum = 0;
  for (int l = std::max(m, 2); l <= kDegrees; ++l) {
    const double p = legendre(l, m, angle);
    sum += p * p / membrane.friction(l);
  }
  const double square = static_cast<double>(m) * m;
  return membrane.capillary * epsilon / (6 * std::sqrt(2.0)) * 2 * kPi * square * (square - 1) /
         std::pow(std::sin(angle), 3) * sum;
}

// The velocity of the centre is the mean of n × ∇ψ over the cap. For a sharp boundary at α′ a mode
// (l, 1) gives √2 π sin α′ P̃_l1(cos α′) over the area's π sin² α′; a boundary of finite width is
// the mean of sharp ones, with −c′(α′) as the weight.
double centre_diffusion(const flow::FluidMembrane& membrane, double epsilon, double angle,
                        int degree) {
  constexpr int kAngles = 2000;
  double sum = 0;
  for (int l = 1; l <= degree; ++l) {
    double moved = 0, area = 0;
    for (int k = 0; k < kAngles; ++k) {
      const double at = (k + 0.5) * kPi / kAngles,
                   c = physics::DoubleWell().profile(at - angle, epsilon);
      const double weight = c * (1 - c);  // −c′ but for a factor
      moved += weight * std::sqrt(2.0) * kPi * std::sin(at) * legendre(l, 1, at);
      area += weight * kPi * std::sin(at) * std::sin(at);
    }
    sum += moved * moved / (area * area) / membrane.friction(l);
  }
  return membrane.thermal * sum;
}

}  // namespace traceraft::analytic
