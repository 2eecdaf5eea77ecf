#include "kernel/geometry/surface_entries.hpp"

namespace traceraft::geometry {
namespace {

// Exact signed distance to the unit sphere: the surface of the reference results.
class Sphere final : public LevelSet {
 public:
  double value(const Point& x) const override { return x.norm() - 1; }
};

}  // namespace

SurfaceEntry sphere_surface() {
  return {"sphere", "unit sphere (a vesicle of radius R)", {}, [](const Parameters&) {
            return std::make_shared<Sphere>();
          }};
}

}  // namespace traceraft::geometry
