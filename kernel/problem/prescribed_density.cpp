#include <stdexcept>

#include "kernel/fem/trace.hpp"
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
    const CutSurface& surface = space.surface;
    const Vec load = point_loads(space, [&](int triangle) {
      const auto& [i, j, k] = surface.triangles[triangle];
      const Point corner[3] = {surface.position[i], surface.position[j], surface.position[k]};
      std::array<double, 3> corner_load{};
      for (const auto& [at, weight] : kDegreeFourRule) {
        const Point x = at[0] * corner[0] + at[1] * corner[1] + at[2] * corner[2];
        const double value = weight * surface.triangle_area[triangle] * density_(x, t);
        for (int a = 0; a < 3; ++a) corner_load[a] += value * at[a];
      }
      return corner_load;
    });
    add_trace_transpose(space, sign, load, target);
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
