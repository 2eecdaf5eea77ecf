#include "kernel/problem/prescribed_density.hpp"

#include <stdexcept>

namespace traceraft::problem {
namespace {

class PrescribedDensity final : public Effect {
 public:
  PrescribedDensity(std::string name, Slot slot, Density density)
      : name_(std::move(name)), slot_(slot), density_(std::move(density)) {}

  std::string name() const override { return name_; }
  bool conserves_mass() const override { return slot_ != Slot::source; }
  bool dissipates_energy() const override { return false; }

  void add_residual(const fem::SurfaceSpace& space, double t, VecView, VecView, VecRef residual_c,
                    VecRef residual_mu) const override {
    VecRef target = slot_ == Slot::source ? residual_c : residual_mu;
    const double sign = slot_ == Slot::source ? 1 : -1;
    fem::add_density_load(
        space, sign, [&](const fem::QuadraturePoint& at) { return density_(at, t); }, target);
  }
  void add_tangent(const fem::SurfaceSpace&, double, VecView, VecView,
                   linear::BlockJacobian&) const override {}
  void add_tangent_product(const fem::SurfaceSpace&, double, VecView, VecView, VecView, VecView,
                           VecRef, VecRef) const override {}

 private:
  std::string name_;
  Slot slot_;
  Density density_;
};

}  // namespace

EffectPtr prescribed_density(std::string name, Slot slot, Density density) {
  if (slot == Slot::flux) throw std::invalid_argument("a prescribed density is no flux");
  return std::make_shared<PrescribedDensity>(std::move(name), slot, std::move(density));
}

}  // namespace traceraft::problem
