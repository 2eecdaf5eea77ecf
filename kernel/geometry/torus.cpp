#include <cmath>

#include "kernel/geometry/surface_entries.hpp"

namespace traceraft::geometry {
namespace {

// Exact signed distance to a torus around the z axis.
class Torus final : public LevelSet {
 public:
  Torus(double major, double minor) : major_(major), minor_(minor) {}
  double value(const Point& x) const override {
    return std::hypot(std::hypot(x[0], x[1]) - major_, x[2]) - minor_;
  }

 private:
  double major_, minor_;
};

}  // namespace

SurfaceEntry torus_surface() {
  return {"torus",
          "torus around the z axis",
          {{"major", "R", 1.0, 0.2, 1.5, "distance from the axis to the centre of the tube"},
           {"minor", "R", 0.4, 0.05, 0.8, "radius of the tube"}},
          [](const Parameters& p) {
            if (!(p["minor"] < p["major"]))
              throw InputError("surface 'torus': minor=" + format_number(p["minor"]) +
                               " must be smaller than major=" + format_number(p["major"]));
            return std::make_shared<Torus>(p["major"], p["minor"]);
          }};
}

}  // namespace traceraft::geometry
