#include <cmath>

#include "kernel/geometry/surface_entries.hpp"

namespace traceraft::geometry {
namespace {

// A red blood cell as the quartic (x²+y²+z²)² + P (x²+y²) + Q z² + S = 0 of Kuchel & Fackerell,
// "Parametric-equation representation of biconcave erythrocytes", Bull. Math. Biol. 61 (1999).
// A polynomial has no spurious zeros away from the cell, unlike the Evans–Fung profile.
class Biconcave final : public LevelSet {
 public:
  // Diameter d, thickness b in the middle, largest thickness h.
  Biconcave(double d, double b, double h) {
    const double ratio = d * d / (b * b);
    p_ = -d * d / 2 + h * h / 2 * (ratio - 1) * (1 - std::sqrt(1 - b * b / (h * h)));
    q_ = p_ * ratio + b * b / 4 * (ratio * ratio - 1);
    s_ = -p_ * d * d / 4 - d * d * d * d / 16;
  }
  double value(const Point& x) const override {
    const double rho2 = x[0] * x[0] + x[1] * x[1], z2 = x[2] * x[2];
    return (rho2 + z2) * (rho2 + z2) + p_ * rho2 + q_ * z2 + s_;
  }

 private:
  double p_, q_, s_;
};

}  // namespace

SurfaceEntry biconcave_surface() {
  return {"biconcave",
          "red blood cell (Kuchel-Fackerell quartic), axis along z, radius 1",
          {{"middle", "R", 0.25, 0.1, 1.0, "thickness in the middle"},
           {"rim", "R", 0.53, 0.2, 1.2, "largest thickness"}},
          [](const Parameters& p) {
            if (!(p["middle"] < p["rim"]))
              throw InputError("surface 'biconcave': middle=" + format_number(p["middle"]) +
                               " must be smaller than rim=" + format_number(p["rim"]));
            return std::make_shared<Biconcave>(2.0, p["middle"], p["rim"]);
          }};
}

}  // namespace traceraft::geometry
