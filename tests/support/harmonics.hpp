// Real spherical harmonics from the standard library: a reference for those of the kernel.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "kernel/core/types.hpp"

namespace traceraft::testing {

// Orthonormal; only the direction of the point counts.
inline double exact_harmonic(int l, int m, const Point& point) {
  const auto order = static_cast<unsigned>(std::abs(m));
  const double theta = std::acos(std::clamp(point.normalized()[2], -1.0, 1.0)),
               phi = std::atan2(point[1], point[0]);
  // std::sph_legendre is normalised over the whole sphere, with the sign (−1)^m.
  const double of_theta = std::sph_legendre(static_cast<unsigned>(l), order, theta);
  if (m == 0) return of_theta;
  return (order % 2 == 0 ? 1 : -1) * std::sqrt(2.0) * of_theta *
         (m > 0 ? std::cos(m * phi) : std::sin(-m * phi));
}

}  // namespace traceraft::testing
