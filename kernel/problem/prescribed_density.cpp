#include <stdexcept>

#include "kernel/fem/triangle_rule.hpp"
#include "kernel/problem/effect.hpp"

namespace traceraft {
namespace {

class PrescribedDensity final : public Effect {
 public:
  PrescribedDensity(std::string name, Slot slot,
                    std::function<double(const Point&, double)> density)
      : name_(std::move(name)), slot_(slot), density_(std::move(density)) {}

  std::string name() const override { return name_; }
  bool conserves_mass() const override { return slot_ != Slot::source; }
  bool dissipates_energy() const override { return false; }

  void add_residual(const SurfaceSpace& space, double t, ConstVec, ConstVec, VecRef residual_c,
                    VecRef residual_mu) const override {
    VecRef target = slot_ == Slot::source ? residual_c : residual_mu;
    const double sign = slot_ == Slot::source ? 1 : -1;
    for_each_row_contribution(
        space.elements, space.blocks, *space.team,
        [&](const CutElement& element, int) {
          const std::array<Point, 4> corner = corners_of(space.mesh, element);
          std::array<double, 4> load{}, nodal{};
          for (int k = 0; k < element.triangles(); ++k) {
            const auto& v = kPolygonTriangles[k];
            for (const auto& [at, weight] : kDegreeFourRule) {
              const Point x = at[0] * corner[v[0]] + at[1] * corner[v[1]] + at[2] * corner[v[2]];
              const double value = sign * weight * element.triangle_area[k] * density_(x, t);
              for (int a = 0; a < 3; ++a) load[v[a]] += value * at[a];
            }
          }
          element.distribute(load, nodal);
          return nodal;
        },
        [&](int row, double value) { target[row] += value; });
  }
  void add_tangent(const SurfaceSpace&, double, ConstVec, ConstVec, BlockJacobian&) const override {
  }
  void add_tangent_product(const SurfaceSpace&, double, ConstVec, ConstVec, ConstVec, ConstVec,
                           VecRef, VecRef) const override {}

 private:
  std::string name_;
  Slot slot_;
  std::function<double(const Point&, double)> density_;
};

}  // namespace

EffectPtr prescribed_density(std::string name, Slot slot,
                             std::function<double(const Point&, double)> density) {
  if (slot == Slot::flux) throw std::invalid_argument("a prescribed density is no flux");
  return std::make_shared<PrescribedDensity>(std::move(name), slot, std::move(density));
}

}  // namespace traceraft
