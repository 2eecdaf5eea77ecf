// The spectrum of a field on the sphere in spherical harmonics.
#pragma once

#include <vector>

#include "kernel/fem/surface_space.hpp"

namespace traceraft::bench {

// S_l = Σ_m |∫ c Y_lm|² for l = 0 … highest, with real orthonormal harmonics on the unit sphere:
// the sum over l is ∫ c². c at one rank; `highest` not far above 1/h, where the quadrature of
// triangles gives out and noise begins to add up.
std::vector<double> spherical_spectrum(const fem::SurfaceSpace& space, VecView c, int highest);

// Below and above it lies half of the power of l > 0, a degree being spread over l ± ½: 2π over it
// is a length. The mean is none where there are sharp boundaries: S_l falls like l^(-2) beyond
// (Porod), so the mean grows with the range of degrees.
double median_degree(const std::vector<double>& spectrum);

}  // namespace traceraft::bench
