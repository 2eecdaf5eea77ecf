#include "kernel/effects/mobility_flux.hpp"

#include "kernel/fem/mobility_stiffness.hpp"

namespace traceraft::effects {
namespace {

class MobilityFlux final : public problem::Effect {
 public:
  MobilityFlux(std::string name, physics::MobilityPtr law, std::function<double(double)> factor,
               bool dissipates)
      : name_(std::move(name)),
        law_(std::move(law)),
        factor_(std::move(factor)),
        dissipates_(dissipates) {}

  std::string name() const override { return name_; }
  bool conserves_mass() const override { return true; }
  bool dissipates_energy() const override { return dissipates_; }

  void add_residual(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                    VecRef residual_c, VecRef) const override {
    fem::add_mobility_flux(space, scaled(fem::mobility_integrals(space, *law_, c), t), mu,
                           residual_c);
  }

  void add_tangent(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                   linear::BlockJacobian& J) const override {
    std::vector<std::array<double, 4>> gradient;
    const std::vector<double> integral =
        scaled(fem::mobility_integrals(space, *law_, c, gradient), t);
    fem::CsrMatrix stiffness(space.pattern);
    fem::assemble_mobility_stiffness(space, integral, stiffness);
    for (std::size_t k = 0; k < stiffness.values.size(); ++k) J.cm.values[k] += stiffness.values[k];
    fem::add_mobility_derivative(space, factor_(t), mu, gradient, J.cc);
  }

  void add_tangent_product(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                           VecView direction_c, VecView direction_mu, VecRef product_c,
                           VecRef) const override {
    std::vector<std::array<double, 4>> gradient;
    fem::add_mobility_flux(space, scaled(fem::mobility_integrals(space, *law_, c, gradient), t),
                           direction_mu, product_c);
    fem::add_mobility_flux(space, scaled(fem::mobility_change(space, gradient, direction_c), t), mu,
                           product_c);
  }

  void add_stabilised(const fem::SurfaceSpace& space, double t, VecView c,
                      linear::BlockJacobian& J) const override {
    add_stiffness(space, scaled(fem::mobility_integrals(space, *law_, c), t), J);
  }
  void add_stabilised_product(const fem::SurfaceSpace& space, double t, VecView c,
                              VecView direction_mu, VecRef product_c) const override {
    fem::add_mobility_flux(space, scaled(fem::mobility_integrals(space, *law_, c), t), direction_mu,
                           product_c);
  }

 private:
  static void add_stiffness(const fem::SurfaceSpace& space, const std::vector<double>& integral,
                            linear::BlockJacobian& J) {
    fem::CsrMatrix stiffness(space.pattern);
    fem::assemble_mobility_stiffness(space, integral, stiffness);
    for (std::size_t k = 0; k < stiffness.values.size(); ++k) J.cm.values[k] += stiffness.values[k];
  }
  std::vector<double> scaled(std::vector<double> integral, double t) const {
    const double factor = factor_(t);
    for (double& value : integral) value *= factor;
    return integral;
  }

  std::string name_;
  physics::MobilityPtr law_;
  std::function<double(double)> factor_;
  bool dissipates_;
};

}  // namespace

problem::EffectPtr mobility_flux(std::string name, physics::MobilityPtr law,
                                 std::function<double(double)> factor, bool dissipates) {
  return std::make_shared<MobilityFlux>(std::move(name), std::move(law), std::move(factor),
                                        dissipates);
}

}  // namespace traceraft::effects
