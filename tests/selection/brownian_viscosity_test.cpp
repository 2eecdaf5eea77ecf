// The viscosity that is told of rafts that meet.
#include "verification/selection/series/brownian_viscosity.hpp"

#include <gtest/gtest.h>

namespace traceraft::selection {
namespace {

physics::Units units_of(double radius_um, double diffusion_cm2_s) {
  physics::Units units;
  units.radius_um = radius_um;
  units.diffusion_cm2_s = diffusion_cm2_s;
  return units;
}

// docs/effects.md: R = 5 µm and 4 nPa s m make W = 1.25, and k_B T is 4.11e-3 pN µm.
TEST(BrownianViscosity, NumbersOfATypicalMembrane) {
  const physics::Units units = units_of(5, 1e-5);
  EXPECT_NEAR(drag_of_water(4, units), 1.25, 1e-12);
  EXPECT_NEAR(thermal_of(4, 298, units), 4.114e-3 / (4e-3 * 1e3), 1e-6);
}

TEST(BrownianViscosity, IsThatOfTheSimulationIfTheDragIsItsOwn) {
  for (const double viscosity : {1.0, 4.0, 20.0}) {
    const physics::Units units = units_of(6.5, 2e-7);
    EXPECT_NEAR(viscosity_of(thermal_of(viscosity, 298, units), drag_of_water(viscosity, units),
                             298, units),
                viscosity, 1e-4 * viscosity);
  }
}

// Simulated rafts felt more drag of water than those of 8 nPa s m do, and met more slowly.
TEST(BrownianViscosity, AllowsForAnotherDrag) {
  const physics::Units units = units_of(5, 1e-6);
  const double thermal = thermal_of(8, 298, units);
  const double found = viscosity_of(thermal, drag_of_water(4, units), 298, units);
  EXPECT_GT(found, 8.5);
  EXPECT_LT(found, 12);
  EXPECT_LT(viscosity_of(thermal, drag_of_water(16, units), 298, units), 7.5);
}

TEST(BrownianViscosity, FlowSaysTheSameNumbers) {
  const physics::Units units = units_of(5, 1e-5);
  const effects::EffectTerm flow = brownian_flow(4, 298, units);
  problem::CahnHilliardModel model;
  const discs::DiscModel discs = effects::disc_model(model, {flow}),
                         same = effects::disc_model(
                             model,
                             {flow_with({0, drag_of_water(4, units), thermal_of(4, 298, units)},
                                        units)});
  EXPECT_NEAR(discs.membrane.thermal, same.membrane.thermal, 1e-12);
  EXPECT_NEAR(discs.membrane.water, same.membrane.water, 1e-12);
}

}  // namespace
}  // namespace traceraft::selection
