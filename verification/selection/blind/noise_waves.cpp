#include "verification/selection/blind/noise_waves.hpp"

#include <cmath>

#include "kernel/core/random.hpp"

namespace traceraft::selection {

// E cos k·d over wave vectors k is the correlation (Bochner): they are normally distributed for a
// Gaussian, and have a Cauchy distribution, a normal one over the size of another, for exp(−d/ℓ).
Vec noise_waves(const std::vector<Point>& points, double length, NoiseShape shape,
                std::uint64_t seed, std::uint64_t stream) {
  constexpr std::uint64_t kWaves = 4096, kNumbers = 5;
  Vec result = Vec::Zero(static_cast<Eigen::Index>(points.size()));
  for (std::uint64_t w = 0; w < kWaves; ++w) {
    const auto normal = [&](std::uint64_t i) {
      return normal_random(seed, stream, kNumbers * w + i);
    };
    Point k = Point(normal(0), normal(1), normal(2)) / length;
    if (shape == NoiseShape::exponential) k /= std::fabs(normal(3));
    const double phase = 2 * kPi * uniform_random(seed, stream, 2 * (kNumbers * w + 4));
    for (std::size_t i = 0; i < points.size(); ++i)
      result[static_cast<Eigen::Index>(i)] += std::cos(k.dot(points[i]) + phase);
  }
  return std::sqrt(2.0 / kWaves) * result;
}

}  // namespace traceraft::selection
