#include "verification/selection/series/brownian_viscosity.hpp"

#include <cmath>

#include "kernel/discs/brownian_motion.hpp"

namespace traceraft::selection {
namespace {

const std::vector<ParameterSpec>& flow_parameters() {
  return effects::effects().find("flow").parameters;
}

std::size_t index_of(const std::string& name) {
  return place_of(name, flow_parameters());
}

double in_model_units(const std::string& name, double value, const physics::Units& units) {
  return value * effects::to_model_units(flow_parameters()[index_of(name)].unit, units);
}

effects::EffectTerm flow_by_default(const physics::Units& units) {
  effects::EffectTerm term{"flow", {}};
  for (const ParameterSpec& spec : flow_parameters())
    term.values.push_back(spec.default_value * effects::to_model_units(spec.unit, units));
  return term;
}

// How fast the distance of two rafts changes, per Θ.
double meeting_rate(double water) {
  constexpr double kHalfAngle = 0.3, kGap = 0.5;
  const double angle = 2 * kHalfAngle + kGap, area = discs::area_of_half_angle(kHalfAngle);
  discs::BrownianMotion motion(flow::FluidMembrane{0, water, 1});
  motion.set_discs({{Point(0, 0, 1), area}, {Point(std::sin(angle), 0, std::cos(angle)), area}});
  return motion.variance_of_distance(0, 1);
}

}  // namespace

double drag_of_water(double viscosity, const physics::Units& units) {
  const std::size_t water = index_of("water-viscosity");
  return flow_by_default(units).values[water] /
         in_model_units("membrane-viscosity", viscosity, units);
}

double thermal_of(double viscosity, double kelvin, const physics::Units& units) {
  return in_model_units("temperature", kelvin, units) /
         in_model_units("membrane-viscosity", viscosity, units);
}

// Θ(η) rate(W(η)) = thermal · rate(water): a fixed point, as the rate depends weakly on W.
double viscosity_of(double thermal, double water, double kelvin, const physics::Units& units) {
  constexpr int kMostPasses = 100;
  constexpr double kTolerance = 1e-6;
  const double sought = thermal * meeting_rate(water), unit = thermal_of(1, kelvin, units);
  double ln_viscosity = std::log(unit / thermal);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const double next =
        std::log(unit * meeting_rate(drag_of_water(std::exp(ln_viscosity), units)) / sought);
    const double change = next - ln_viscosity;
    ln_viscosity += 0.5 * change;
    if (std::fabs(change) < kTolerance) break;
  }
  return std::exp(ln_viscosity);
}

effects::EffectTerm flow_with(const flow::FluidMembrane& membrane, const physics::Units& units) {
  effects::EffectTerm term = flow_by_default(units);
  term.values[index_of("capillary")] = membrane.capillary;
  term.values[index_of("water")] = membrane.water;
  term.values[index_of("thermal")] = membrane.thermal;
  return term;
}

flow::FluidMembrane membrane_of(const effects::EffectTerm& flow) {
  const auto number = [&](const std::string& name) { return flow.values[index_of(name)]; };
  return {number("capillary"), number("water"), number("thermal")};
}

effects::EffectTerm brownian_flow(double viscosity, double kelvin, const physics::Units& units) {
  effects::EffectTerm term = flow_by_default(units);
  term.values[index_of("membrane-viscosity")] =
      in_model_units("membrane-viscosity", viscosity, units);
  term.values[index_of("temperature")] = in_model_units("temperature", kelvin, units);
  return term;
}

}  // namespace traceraft::selection
