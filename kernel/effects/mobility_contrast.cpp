#include "kernel/effects/effects.hpp"

namespace traceraft::effects {
namespace {

// M(c) + b c (1 − c) (2c − 1) within the wells. The floor at zero applies to the sum, hence a law
// of its own instead of a flux of its own.
class ContrastMobility final : public physics::Mobility {
 public:
  ContrastMobility(physics::MobilityPtr base, double b) : base_(std::move(base)), b_(b) {}
  void evaluate(const double* c, int count, double* value, double* derivative) const override {
    base_->evaluate(c, count, value, derivative);
    for (int i = 0; i < count; ++i) {
      if (!(c[i] > 0 && c[i] < 1)) continue;
      const double s = c[i] * (1 - c[i]), d = 1 - 2 * c[i];
      value[i] -= b_ * s * d;
      if (derivative) derivative[i] -= b_ * (d * d - 2 * s);
    }
  }
  double scale() const override { return base_->scale(); }

 private:
  physics::MobilityPtr base_;
  double b_;
};

}  // namespace

EffectEntry mobility_contrast_effect() {
  return {"mobility-contrast",
          "lipids that move faster on the side of the rafts",
          "lipids that move more slowly on the side of the rafts",
          {{"strength", "", 0, -1, 1, "b of b c (1-c) (2c-1), in units of D"}},
          MassClass::conserves,
          EnergyClass::dissipates,
          "mobility of small rafts",
          {"flow"},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            model.mobility = std::make_shared<ContrastMobility>(model.mobility, p["strength"]);
          },
          true,
          1};
}

}  // namespace traceraft::effects
