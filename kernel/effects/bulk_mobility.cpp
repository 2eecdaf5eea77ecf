#include "kernel/effects/effects.hpp"

namespace traceraft::effects {
namespace {

// M(c) + m0.
class BulkMobility final : public physics::Mobility {
 public:
  BulkMobility(physics::MobilityPtr base, double m0) : base_(std::move(base)), m0_(m0) {}
  void evaluate(const double* c, int count, double* value, double* derivative) const override {
    base_->evaluate(c, count, value, derivative);
    for (int i = 0; i < count; ++i) value[i] += m0_;
  }
  double scale() const override { return base_->scale(); }
  bool constant() const override { return base_->constant(); }

 private:
  physics::MobilityPtr base_;
  double m0_;
};

}  // namespace

// Lipids that move within the phases, too, not along boundaries alone.
EffectEntry bulk_mobility_effect() {
  return {"bulk-mobility",
          "a mobility everywhere, so that lipids diffuse through the phases",
          "",
          {{"strength", "", 0, 0, 10, "m0, in units of D"}},
          MassClass::conserves,
          EnergyClass::dissipates,
          "coarsening like t^(1/3) instead of t^(1/4)",
          {"mobility-exponent"},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            model.mobility = std::make_shared<BulkMobility>(model.mobility, p["strength"]);
          },
          false,
          3};
}

}  // namespace traceraft::effects
