#include "kernel/mesh/gradient_check.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "kernel/core/error.hpp"

namespace traceraft::mesh {
namespace {

constexpr std::size_t kSamples = 500;
constexpr double kMostRatio = 10;  // of the gradients, or of their inverses

double gradient_norm(const geometry::LevelSet& surface, const Point& x, double step) {
  Point gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Point e = step * Point::Unit(axis);
    gradient[axis] = (surface.value(x + e) - surface.value(x - e)) / (2 * step);
  }
  return gradient.norm();
}

// Where φ changes its sign between two points: by bisection, which needs no gradient.
Point root_between(const geometry::LevelSet& surface, Point low, Point high) {
  constexpr int kHalvings = 50;
  const bool low_negative = surface.value(low) < 0;
  for (int i = 0; i < kHalvings; ++i) {
    const Point middle = 0.5 * (low + high);
    ((surface.value(middle) < 0) == low_negative ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

struct Samples {
  double all = 0, bad = 0;
  // The ratio that is furthest from 1.
  double distance = 0;  // |ln ratio|
  bool flat = false;
  Point where = Point::Zero();
};

Samples sampled(const geometry::LevelSet& surface, const ActiveMesh& mesh, const CutSurface& cut) {
  Samples samples;
  const std::size_t stride = std::max<std::size_t>(1, cut.points.size() / kSamples);
  for (std::size_t p = 0; p < cut.points.size(); p += stride) {
    const auto& [low, high, s] = cut.points[p];
    const Point x = root_between(surface, mesh.position(low), mesh.position(high));
    const double ratio = relative_gradient(surface, x, mesh.cube.h());
    if (!std::isfinite(ratio)) continue;  // a formula that is defined in the box alone
    const double distance = std::fabs(std::log(std::max(ratio, 1e-300)));
    ++samples.all;
    if (distance > std::log(kMostRatio)) ++samples.bad;
    if (distance > samples.distance) {
      samples.distance = distance;
      samples.flat = ratio < 1;
      samples.where = x;
    }
  }
  return samples;
}

}  // namespace

double relative_gradient(const geometry::LevelSet& surface, const Point& on_surface, double h) {
  return gradient_norm(surface, on_surface, 1e-6 * h) / gradient_norm(surface, on_surface, 0.5 * h);
}

void require_gradient(const geometry::LevelSet& surface, const ActiveMesh& mesh,
                      const CutSurface& cut, double share, const Communicator& ranks) {
  const Samples mine = sampled(surface, mesh, cut);
  if (ranks.sum(mine.bad) <= share * ranks.sum(mine.all)) return;
  std::vector<double> worst = {mine.distance, mine.flat ? 1.0 : 0.0, mine.where[0], mine.where[1],
                               mine.where[2]};
  for (const std::vector<double>& other : gather_everywhere(ranks, worst))
    worst = std::max(worst, other);
  std::ostringstream text;
  text.precision(3);
  text << "the level set "
       << (worst[1] > 0 ? "has hardly any gradient on its surface" : "jumps at its surface")
       << " near (" << worst[2] << ", " << worst[3] << ", " << worst[4]
       << "), where the mesh cannot find it; it must be nearly linear there, as a distance is (f "
          "instead of f^3 or sign(f))";
  throw InputError(text.str());
}

}  // namespace traceraft::mesh
