// Noise that neighbours share, for synthetic measurements: a sum of plane waves with random phases.
// It shares nothing with what estimates such noise.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/core/types.hpp"

namespace traceraft::selection {

// Shapes of the correlation of two values at a distance d.
enum class NoiseShape {
  gaussian,    // exp(−d²/2ℓ²), as of an image that is filtered
  exponential  // exp(−d/ℓ), rough over short distances and long in its tail
};

// Noise at the points, of variance 1 and with correlations over the length ℓ. It is as good as
// normally distributed.
Vec noise_waves(const std::vector<Point>& points, double length, NoiseShape shape,
                std::uint64_t seed, std::uint64_t stream);

}  // namespace traceraft::selection
