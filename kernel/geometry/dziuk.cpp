#include "kernel/geometry/surface_entries.hpp"

namespace traceraft::geometry {
namespace {

// (x − z²)² + y² + z² = 1, the bent test surface of Dziuk, "Finite elements for the Beltrami
// operator on arbitrary surfaces" (1988).
class Dziuk final : public LevelSet {
 public:
  double value(const Point& x) const override {
    const double bent = x[0] - x[2] * x[2];
    return 0.5 * (bent * bent + x[1] * x[1] + x[2] * x[2] - 1);
  }
};

}  // namespace

SurfaceEntry dziuk_surface() {
  return {"dziuk", "Dziuk's bent cell (x - z^2)^2 + y^2 + z^2 = 1", {}, [](const Parameters&) {
            return std::make_shared<Dziuk>();
          }};
}

}  // namespace traceraft::geometry
