// The stabilised Euler scheme: one step by hand, the decay of the energy, threads.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "backends/list.hpp"
#include "kernel/effects/effects.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::time {
namespace {

using testing::make_model;
using testing::make_space;
using testing::noise_state;

TEST(Euler, NeverGainsEnergyWhereItPromisesSo) {
  const auto space = make_space(16);
  long gained_by_second = 0;
  for (const char* kept : {"first", "decaying", "second"})
    for (const char* mobility : {"degenerate", "constant"})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const problem::CahnHilliard problem(space, make_model(mobility, 0.1));
        IntegratorSettings settings;
        settings.kept_solution = kept;
        settings.tolerance = 0.05;  // large steps are where an unstable scheme would show
        const IntegratorPtr integrator = backends::integrators().find("euler").make(
            problem, backends::choose_linear_solver("block", *space), space->team, settings);
        EXPECT_EQ(integrator->promises_energy_decay(), kept != std::string("second"));
        const testing::StartState start = noise_state(problem, seed, 0.4);
        ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 1000).ok());
        const double scale = problem.energy(start.y);
        double energy = scale;
        while (integrator->time() < 1000) {
          ASSERT_TRUE(integrator->advance().ok());
          const double next = problem.energy(integrator->state());
          if (integrator->promises_energy_decay()) {
            ASSERT_LE(next, energy + 1e-10 * scale) << kept << " at t = " << integrator->time();
          } else {
            gained_by_second += next > energy + 1e-10 * scale;
          }
          energy = next;
        }
      }
  EXPECT_GT(gained_by_second, 0) << "the test is too gentle to tell the solutions apart";
}

// Sources that it has of the step before may gain energy, also where the model cannot.
TEST(Euler, PromisesNothingOfSourcesThatItTreatsExplicitly) {
  const auto space = make_space(8);
  const auto promises = [&](const std::string& effect) {
    problem::CahnHilliardModel model = make_model();
    effects::add_effects(effect, {1, 1, true}, model);
    const problem::CahnHilliard problem(space, model);
    EXPECT_TRUE(problem.dissipates_energy()) << effect;
    IntegratorSettings settings;
    settings.kept_solution = "first";
    return backends::integrators()
        .find("euler")
        .make(problem, backends::choose_linear_solver("block", *space), space->team, settings)
        ->promises_energy_decay();
  };
  for (const char* effect : {"gravity:strength=0.1", "asymmetry:strength=0.1",
                             "line-tension:excess=0.5", "bulk-mobility:strength=0.1"})
    EXPECT_TRUE(promises(effect)) << effect;
  for (const char* effect : {"allen-cahn:rate=1", "ohta-kawasaki:strength=1,range=1"})
    EXPECT_FALSE(promises(effect)) << effect;
}

// Nothing to be relative to but what the source brings.
TEST(Euler, StartsFromNothing) {
  const auto space = make_space(8);
  problem::CahnHilliardModel model = make_model();
  effects::add_effects("uptake:rate=1", {1, 1, true}, model);
  const problem::CahnHilliard problem(space, model);
  IntegratorSettings settings;
  settings.tolerance = 1e-3;
  const IntegratorPtr integrator = backends::integrators().find("euler").make(
      problem, backends::choose_linear_solver("block", *space), space->team, settings);
  Vec y = Vec::Zero(problem.size()), ydot = y;
  ASSERT_TRUE(problem.consistent_initial_state(0, y, ydot).ok());
  ASSERT_TRUE(integrator->start(0, y, ydot, 1).ok());
  while (integrator->time() < 1) {
    const Status status = integrator->advance();
    ASSERT_TRUE(status.ok()) << status.why;
  }
  // ċ = 1 − c
  EXPECT_NEAR(problem.mass(integrator->state()) / space->area, 1 - std::exp(-1.0), 0.01);
}

TEST(Euler, OneStepIsTheHandAssembledStabilisedScheme) {
  // (M̃/Δt + …): M̃ (c − c_n)/Δt + A μ = 0, M̃ μ = b(c_n) + β M̃ (c − c_n) + ε² (K + ρS) c, as one
  // dense system.
  const auto space = make_space(8);
  const problem::CahnHilliard problem(space, make_model());
  const int n = problem.block_size();
  const testing::StartState start = noise_state(problem);
  IntegratorSettings settings;
  settings.initial_step = 1e-3;
  settings.tolerance = 0.5;
  const IntegratorPtr integrator = backends::integrators().find("euler").make(
      problem, backends::choose_linear_solver("direct", *space), space->team, settings);
  ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 1).ok());
  ASSERT_TRUE(integrator->advance().ok());
  ASSERT_EQ(integrator->time(), 1e-3);

  linear::BlockJacobian J = problem.make_jacobian();
  ASSERT_TRUE(problem.jacobian(0, start.y, start.ydot, 1e3, linear::Tangent::stabilised, J).ok());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  const fem::SparsityPattern& p = *space->pattern;
  for (int i = 0; i < n; ++i)
    for (int k = p.row_begin[i]; k < p.row_begin[i + 1]; ++k) {
      system(i, p.column[k]) = 1e3 * space->stabilised_mass.values[k];
      system(i, n + p.column[k]) = J.cm.values[k];
      system(n + i, n + p.column[k]) = space->stabilised_mass.values[k];
      system(n + i, p.column[k]) =
          -0.04 * (space->stiffness.values[k] + space->h() * space->normal_stiffness.values[k]) -
          space->stabilised_mass.values[k];
    }
  Vec right = Vec::Zero(2 * n);
  const Vec c = start.y.head(n);
  space->stabilised_mass.multiply_add(1e3, c, right.head(n), *space->team);
  fem::add_potential(*space, problem.model().well, problem.model().rule, 1, c, right.tail(n));
  space->stabilised_mass.multiply_add(-1, c, right.tail(n), *space->team);
  const Vec expected = system.partialPivLu().solve(right);
  EXPECT_LT((integrator->state() - expected).norm(), 1e-10 * expected.norm());
}

TEST(Euler, DoesNotDependOnThreads) {
  Vec states[2];
  for (const int threads : {1, 2}) {
    const auto space = make_space(12, "sphere", threads);
    const problem::CahnHilliard problem(space, make_model());
    const testing::StartState start = noise_state(problem);
    const IntegratorPtr integrator = backends::integrators().find("euler").make(
        problem, backends::choose_linear_solver("block", *space), space->team, {});
    ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 1).ok());
    while (integrator->time() < 1) ASSERT_TRUE(integrator->advance().ok());
    states[threads - 1] = integrator->state();
  }
  EXPECT_EQ(states[0], states[1]);
}

}  // namespace
}  // namespace traceraft::time
