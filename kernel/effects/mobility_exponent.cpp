#include <algorithm>
#include <cmath>

#include "kernel/effects/effects.hpp"

namespace traceraft::effects {
namespace {

// M(c) (4 |c (1 − c)|)^δ: with M = |c (1 − c)| the exponent 1 + δ, with the same value at c = 1/2,
// and outside of [0, 1] likewise: curved boundaries push c out by some ε/R.
class ExponentMobility final : public physics::Mobility {
 public:
  ExponentMobility(physics::MobilityPtr base, double more) : base_(std::move(base)), more_(more) {}
  void evaluate(const double* c, int count, double* value, double* derivative) const override {
    base_->evaluate(c, count, value, derivative);
    for (int i = 0; i < count; ++i) {
      const double s = c[i] * (1 - c[i]), size = std::fabs(s);
      // Constant next to the wells, where negative powers grow without bound.
      const double factor = std::pow(4 * std::max(size, kLeast), more_), before = value[i];
      value[i] *= factor;
      if (!derivative) continue;
      derivative[i] *= factor;
      if (size > kLeast) derivative[i] += before * more_ * factor / s * (1 - 2 * c[i]);
    }
  }
  double scale() const override { return base_->scale(); }

 private:
  static constexpr double kLeast = 1e-6;
  physics::MobilityPtr base_;
  double more_;
};

}  // namespace

EffectEntry mobility_exponent_effect() {
  return {"mobility-exponent",
          "a mobility that vanishes faster in the phases",
          "a mobility that vanishes more slowly in the phases",
          {{"excess", "", 0, -0.9, 5, "delta of (c (1-c))^(1 + delta)"}},
          MassClass::conserves,
          EnergyClass::dissipates,
          "speed of coarsening",
          {"bulk-mobility"},
          [](const Parameters& p, problem::CahnHilliardModel& model) {
            model.mobility = std::make_shared<ExponentMobility>(model.mobility, p["excess"]);
          },
          true,
          2};
}

}  // namespace traceraft::effects
