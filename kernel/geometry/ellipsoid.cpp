#include "kernel/geometry/surface_entries.hpp"

namespace traceraft::geometry {
namespace {

class Ellipsoid final : public LevelSet {
 public:
  explicit Ellipsoid(const Point& semi_axes) : inverse_(semi_axes.cwiseInverse()) {}
  double value(const Point& x) const override {
    return 0.5 * (x.cwiseProduct(inverse_).squaredNorm() - 1);
  }

 private:
  Point inverse_;
};

}  // namespace

SurfaceEntry ellipsoid_surface() {
  return {"ellipsoid",
          "ellipsoid with semi-axes a, b, c along x, y, z",
          {{"a", "R", 1.2, 0.1, 1.6, "semi-axis along x"},
           {"b", "R", 1.0, 0.1, 1.6, "semi-axis along y"},
           {"c", "R", 0.8, 0.1, 1.6, "semi-axis along z"}},
          [](const Parameters& p) {
            return std::make_shared<Ellipsoid>(Point(p["a"], p["b"], p["c"]));
          }};
}

}  // namespace traceraft::geometry
