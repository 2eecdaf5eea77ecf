#include "kernel/core/random.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/types.hpp"

namespace traceraft {

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> x,
                                        std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t product0 = std::uint64_t{0xD2511F53} * x[0];
    const std::uint64_t product1 = std::uint64_t{0xCD9E8D57} * x[2];
    x = {static_cast<std::uint32_t>(product1 >> 32) ^ x[1] ^ key[0],
         static_cast<std::uint32_t>(product1),
         static_cast<std::uint32_t>(product0 >> 32) ^ x[3] ^ key[1],
         static_cast<std::uint32_t>(product0)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return x;
}

double uniform_random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  const auto low = [](std::uint64_t v) { return static_cast<std::uint32_t>(v); };
  const auto high = [](std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32); };
  const auto bits =
      philox4x32({low(index), high(index), low(stream), high(stream)}, {low(seed), high(seed)});
  const std::uint64_t mantissa = (std::uint64_t{bits[1]} << 32 | bits[0]) >> 11;
  return (static_cast<double>(mantissa) + 0.5) * 0x1p-53;
}

std::array<double, 2> normal_pair(double u, double v) {
  const double r = std::sqrt(-2 * std::log(u)), angle = 2 * kPi * v;
  return {r * std::cos(angle), r * std::sin(angle)};
}

Point uniform_direction(double u, double v) {
  const double z = 2 * u - 1, angle = 2 * kPi * v, r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

double normal_random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  return normal_pair(uniform_random(seed, stream, 2 * index),
                     uniform_random(seed, stream, 2 * index + 1))[0];
}

int random_index(int count, std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  return std::min(count - 1, static_cast<int>(uniform_random(seed, stream, index) * count));
}

}  // namespace traceraft
