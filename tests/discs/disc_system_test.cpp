#include "kernel/discs/disc_system.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "kernel/core/error.hpp"
#include "kernel/discs/random_discs.hpp"

namespace traceraft::discs {
namespace {

DiscModel brownian_model(double thermal) {
  DiscModel result;
  result.mobility = physics::make_mobility("degenerate");
  result.epsilon = 0.01;
  result.membrane = {0, 1.25, thermal};
  return result;
}

DiscState random_state(int number, std::uint64_t seed = 1) {
  RandomDiscs asked;
  asked.number = number;
  asked.epsilon = 0.01;
  asked.seed = seed;
  const DiscState state = start_state(brownian_model(0), random_discs(asked));
  EXPECT_NEAR(state.mass, 4 * kPi * asked.raft_fraction, 1e-12);
  return state;
}

void run_until(DiscSystem& system, double t) {
  while (system.state().t < t) ASSERT_TRUE(system.advance(t).ok());
}

double held_by_discs(const DiscSystem& system) {
  double sum = 0, covered = 0;
  for (const Disc& disc : system.state().discs) {
    sum += system.phases().mass(disc.area);
    covered += disc.area;
  }
  return sum + system.background(system.state()) * (4 * kPi - covered);
}

TEST(DiscSystemTest, KeepsTheMassAndLosesEnergyWhileDiscsRipenAndMerge) {
  DiscSystem system(brownian_model(1e-3), 1e-3, random_state(60));
  const double mass = system.state().mass;
  double energy = system.energy(system.state());
  while (system.state().t < 2000) {
    ASSERT_TRUE(system.advance(2000).ok());
    EXPECT_NEAR(held_by_discs(system), mass, 1e-12);
    const double next = system.energy(system.state());
    EXPECT_LT(next, energy + 1e-4 * energy);
    energy = next;
  }
  EXPECT_GT(system.statistics().merged, 5);
  EXPECT_GT(system.statistics().dissolved, 5);
  EXPECT_LT(system.state().discs.size(), 10U);
}

TEST(DiscSystemTest, DiscsThatTouchBecomeOneAtTheirCommonCentre) {
  DiscState state;
  state.discs = {{{1, 0, 0}, 0.3}, {Point(std::cos(0.55), std::sin(0.55), 0), 0.2}};
  state.mass = 1;
  const DiscSystem system(brownian_model(0), 1e-3, state);
  ASSERT_EQ(system.state().discs.size(), 1U);
  const Disc& merged = system.state().discs[0];
  const Phases& phases = system.phases();
  EXPECT_NEAR(phases.mass(merged.area), phases.mass(0.3) + phases.mass(0.2), 1e-12);
  EXPECT_NEAR(merged.centre.norm(), 1, 1e-15);
  EXPECT_NEAR(merged.centre[2], 0, 1e-15);
  const double turned = std::atan2(merged.centre[1], merged.centre[0]);
  EXPECT_GT(turned, 0.15);
  EXPECT_LT(turned, 0.275);  // nearer to the larger one
}

TEST(DiscSystemTest, GoesOnBitwiseFromWhatItSaved) {
  DiscSystem whole(brownian_model(1e-3), 1e-3, random_state(40)), first = whole;
  run_until(whole, 100);
  for (int k = 0; k < 57; ++k) ASSERT_TRUE(first.advance(100).ok());
  std::stringstream saved;
  first.save(saved);
  DiscSystem second(brownian_model(1e-3), 1e-3, random_state(40));
  second.load(saved);
  run_until(second, 100);
  ASSERT_EQ(second.state().discs.size(), whole.state().discs.size());
  for (std::size_t k = 0; k < whole.state().discs.size(); ++k) {
    EXPECT_EQ(second.state().discs[k].area, whole.state().discs[k].area);
    EXPECT_EQ(second.state().discs[k].centre, whole.state().discs[k].centre);
  }
  std::istringstream torn(saved.str().substr(0, 100));
  EXPECT_THROW(second.load(torn), IoError);
}

// c = 1 is where uptake ends: ∫ (1 − c) falls like e^(−st).
TEST(DiscSystemTest, TakesUpWhatTheRateSays) {
  DiscModel fed = brownian_model(0);
  fed.uptake = 0.01;
  DiscSystem system(fed, 1e-4, random_state(10));
  const double lacking = 4 * kPi - system.state().mass;
  run_until(system, 5);
  EXPECT_NEAR(4 * kPi - system.state().mass, lacking * std::exp(-0.05), 1e-6);
  EXPECT_NEAR(held_by_discs(system), system.state().mass, 1e-12);
}

// Long steps are tried where nothing changes any more, and explicit methods overshoot then.
TEST(DiscSystemTest, OneDiscInEquilibriumStays) {
  for (const double tolerance : {1e-3, 1e-2, 5e-2}) {
    DiscState state;
    state.discs = {{{0, 0, 1}, 1.9}};
    state.mass = 2;
    DiscSystem system(brownian_model(0), tolerance, state);
    run_until(system, 1e6);
    ASSERT_EQ(system.state().discs.size(), 1U) << tolerance;
    EXPECT_NEAR(system.state().discs[0].area, 1.98, 0.02 + 2 * tolerance);
  }
}

// Rafts meet sooner with more thermal motion. Means over seeds.
TEST(DiscSystemTest, BrownianMotionMergesDiscs) {
  const auto rafts = [](double thermal) {
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      DiscModel physics = brownian_model(thermal);
      physics.seed = seed;
      DiscSystem system(physics, 1e-2, random_state(50, seed));
      run_until(system, 100);
      sum += static_cast<double>(system.state().discs.size());
    }
    return sum / 10;
  };
  EXPECT_GT(rafts(0), rafts(1e-2) + 5);
}

// Steps that end somewhere show discs where they are then, however far their next walk is.
TEST(DiscSystemTest, ADiscHasWanderedAsFarAsItsMotionSays) {
  constexpr int kSeeds = 300;
  constexpr double kTimes[] = {0.5, 1, 2};
  double squares[] = {0, 0, 0}, rate = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    DiscModel physics = brownian_model(1e-2);
    physics.seed = static_cast<std::uint64_t>(seed);
    DiscState state;
    state.discs = {{{0, 0, 1}, 0.2}};
    state.mass = 0.4;
    DiscSystem system(physics, 1e-2, state);
    rate = physics.membrane.spreading_rate(half_angle(system.state().discs[0].area));
    for (int k = 0; k < 3; ++k) {
      run_until(system, kTimes[k]);
      squares[k] += (system.state().discs[0].centre - Point(0, 0, 1)).squaredNorm() / kSeeds;
    }
  }
  // The sum of two squares with one variance has a relative deviation of 1 over the root of seeds.
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(squares[k] / (rate * kTimes[k]), 1, 3.5 / std::sqrt(kSeeds)) << k;
}

TEST(RandomDiscsTest, HaveTheMassThatIsAskedForAndDoNotTouch) {
  RandomDiscs asked;
  asked.number = 80;
  asked.epsilon = 0.01;
  const StartingDiscs start = random_discs(asked);
  const std::vector<Disc>& discs = start.discs;
  ASSERT_EQ(discs.size(), 80U);
  double mass = 4 * kPi * start.background;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    mass += (1 - start.background) * (discs[i].area + boundary_mass(asked.well, asked.epsilon));
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(gap(discs[i], discs[j]), contact_distance(asked.well, asked.epsilon));
  }
  EXPECT_NEAR(mass, 4 * kPi * asked.raft_fraction, 1e-12);
  asked.number = 2000;
  EXPECT_THROW(random_discs(asked), InputError);
  asked.number = 60;
  asked.raft_fraction = 0.8;
  EXPECT_THROW(random_discs(asked), InputError);
}

}  // namespace
}  // namespace traceraft::discs
