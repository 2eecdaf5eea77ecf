// Surfaces that lie anyhow in the mesh.
#pragma once

#include <cmath>
#include <cstdint>

#include "kernel/core/random.hpp"
#include "kernel/geometry/level_set.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::bench {

// A rotation, uniform on all of them, and a shift of up to `largest_shift` along each axis; each
// number gives another.
struct Motion {
  Eigen::Matrix3d turn;
  Point shift;

  Motion(std::uint64_t number, double largest_shift) {
    const auto draw = [&](std::uint64_t k) {
      return uniform_random(number, statistics::position_stream::motion, k);
    };
    // Shoemake, Graphics Gems III (1992).
    const double u = draw(0), v = 2 * kPi * draw(1), w = 2 * kPi * draw(2);
    turn = Eigen::Quaterniond(std::sqrt(1 - u) * std::sin(v), std::sqrt(1 - u) * std::cos(v),
                              std::sqrt(u) * std::sin(w), std::sqrt(u) * std::cos(w))
               .toRotationMatrix();
    for (int i = 0; i < 3; ++i) shift[i] = largest_shift * (2 * draw(3 + i) - 1);
  }
  Point home(const Point& x) const { return turn * (x - shift); }
};

inline geometry::LevelSetPtr moved(const geometry::LevelSetPtr& base, const Motion& motion) {
  return std::make_shared<geometry::FunctionLevelSet>(
      [=](const Point& x) { return base->value(motion.home(x)); });
}

}  // namespace traceraft::bench
