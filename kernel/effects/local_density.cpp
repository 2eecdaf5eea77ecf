#include "kernel/effects/local_density.hpp"

#include "kernel/fem/density_load.hpp"
#include "kernel/fem/weighted_mass.hpp"

namespace traceraft::effects {
namespace {

class LocalDensityEffect final : public problem::Effect {
 public:
  explicit LocalDensityEffect(LocalDensity density) : density_(std::move(density)) {}

  std::string name() const override { return density_.name; }
  bool conserves_mass() const override { return density_.conserves_mass; }
  bool dissipates_energy() const override { return density_.dissipates_energy; }
  // A source has the μ of the step before.
  bool dissipates_explicitly() const override {
    return density_.dissipates_energy && density_.slot == problem::Slot::potential;
  }

  void add_residual(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                    VecRef residual_c, VecRef residual_mu) const override {
    const Values at(*this, space, t, c, mu);
    fem::add_density_load(
        space, sign(), [&](const fem::QuadraturePoint& point) { return at(point).value; },
        density_.slot == problem::Slot::source ? residual_c : residual_mu);
  }

  void add_tangent(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                   linear::BlockJacobian& J) const override {
    const Values at(*this, space, t, c, mu);
    const bool source = density_.slot == problem::Slot::source;
    fem::add_weighted_masses<2>(space, sign(),
                                [&](int triangle, std::size_t p) -> std::array<double, 2> {
                                  const DensityValue density = at(fem::quadrature_point(
                                      space.surface, static_cast<std::size_t>(triangle), p));
                                  return {density.by_c, density.by_mu};
                                },
                                {source ? &J.cc : &J.mc, source ? &J.cm : &J.mm});
  }

  void add_tangent_product(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                           VecView direction_c, VecView direction_mu, VecRef product_c,
                           VecRef product_mu) const override {
    const Values at(*this, space, t, c, mu);
    const Vec along_c = fem::trace(space, direction_c), along_mu = fem::trace(space, direction_mu);
    fem::add_density_load(
        space, sign(),
        [&](const fem::QuadraturePoint& point) {
          const DensityValue value = at(point);
          return value.by_c * point.value(space.surface, along_c) +
                 value.by_mu * point.value(space.surface, along_mu);
        },
        density_.slot == problem::Slot::source ? product_c : product_mu);
  }

  double energy(const fem::SurfaceSpace& space, VecView c) const override {
    if (density_.slot == problem::Slot::source) return 0;
    const Values at(*this, space, 0, c, Vec::Zero(c.size()));
    Vec load = Vec::Zero(space.nodes());
    fem::add_density_load(
        space, 1, [&](const fem::QuadraturePoint& point) { return at(point).energy; }, load);
    return space.communicator->sum(load.sum());  // the basis functions sum to one
  }

 private:
  // The density at the points of the quadrature.
  class Values {
   public:
    Values(const LocalDensityEffect& effect, const fem::SurfaceSpace& space, double t, VecView c,
           VecView mu)
        : value_(effect.density_.value),
          space_(space),
          t_(t),
          c_(fem::trace(space, c)),
          mu_(fem::trace(space, mu)) {}
    DensityValue operator()(const fem::QuadraturePoint& point) const {
      return value_(
          {point.x, t_, point.value(space_.surface, c_), point.value(space_.surface, mu_)});
    }

   private:
    const std::function<DensityValue(const DensityPoint&)>& value_;
    const fem::SurfaceSpace& space_;
    double t_;
    Vec c_, mu_;
  };

  double sign() const { return density_.slot == problem::Slot::source ? 1 : -1; }

  LocalDensity density_;
};

}  // namespace

problem::EffectPtr local_density(LocalDensity density) {
  return std::make_shared<LocalDensityEffect>(std::move(density));
}

}  // namespace traceraft::effects
