// Counter-based random numbers: a draw depends on (seed, stream, index) only, never on the order
// of the draws, the number of threads or the number of ranks.
#pragma once

#include <array>
#include <cstdint>

#include "kernel/core/types.hpp"

namespace traceraft {

// Philox4x32 with 10 rounds (Salmon, Moraes, Dror, Shaw: "Parallel random numbers: as easy as
// 1, 2, 3", SC 2011).
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

// Uniform in the open interval (0, 1) with 53 random bits.
double uniform_random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index);

// Two independent normal numbers from two uniform ones in (0, 1) (Box and Muller).
std::array<double, 2> normal_pair(double u, double v);

// Uniform on the unit sphere from two uniform numbers in (0, 1).
Point uniform_direction(double u, double v);

// The normal number of the uniform ones at 2 index and 2 index + 1.
double normal_random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index);

// One of 0 … count − 1.
int random_index(int count, std::uint64_t seed, std::uint64_t stream, std::uint64_t index);

}  // namespace traceraft
