// The promises of every integrator (kernel/time/integrator.hpp), and what it does when things fail.
#include <gtest/gtest.h>

#include <sstream>

#include "backends/list.hpp"
#include "tests/support/faulty.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::time {
namespace {

using testing::Faulty;
using testing::make_model;
using testing::make_space;
using testing::noise_state;
using testing::Poisoned;

class IntegratorContract : public ::testing::TestWithParam<std::string> {
 protected:
  // Two threads, so that the solves of a step really run at the same time.
  IntegratorContract() : space(make_space(12, "sphere", 2)), problem(space, make_model()) {}

  IntegratorPtr make(const problem::DaeProblem& dae, const std::string& solver = "direct",
                     IntegratorSettings settings = {}) const {
    return backends::integrators()
        .find(GetParam())
        .make(dae, backends::choose_linear_solver(solver, *space), space->team, settings);
  }
  IntegratorPtr started(const problem::DaeProblem& dae, double t_end,
                        const linear::LinearSolverChoice& choice,
                        IntegratorSettings settings = {}) const {
    IntegratorPtr integrator =
        backends::integrators().find(GetParam()).make(dae, choice, space->team, settings);
    const testing::StartState start = noise_state(problem);
    EXPECT_TRUE(integrator->start(0, start.y, start.ydot, t_end).ok());
    return integrator;
  }
  static Status run(Integrator& integrator, double t_end) {
    Status status;
    while (status.ok() && integrator.time() < t_end) status = integrator.advance();
    return status;
  }
  linear::LinearSolverChoice faulty(Faulty::Plan plan, bool with_fallback) const {
    linear::LinearSolverChoice choice = backends::choose_linear_solver("block", *space);
    linear::LinearSolverFactory inner = choice.primary;
    choice.primary = [inner, plan](int lanes) {
      return std::make_unique<Faulty>(inner(lanes), plan);
    };
    if (!with_fallback) choice.fallback = nullptr;
    return choice;
  }

  std::shared_ptr<const fem::SurfaceSpace> space;
  problem::CahnHilliard problem;
};

TEST_P(IntegratorContract, EndsExactlyAtTheEndAndGoesNoFurther) {
  const IntegratorPtr integrator =
      started(problem, 0.7, backends::choose_linear_solver("block", *space));
  ASSERT_TRUE(run(*integrator, 0.7).ok());
  EXPECT_EQ(integrator->time(), 0.7);
  EXPECT_EQ(integrator->advance().outcome, Outcome::fatal);
  EXPECT_EQ(integrator->time(), 0.7);
}

TEST_P(IntegratorContract, KeepsMassWithEverySolver) {
  std::uint64_t seed = 0;  // each solver has another initial state
  for (const std::string& solver : backends::built_linear_solvers()) {
    const IntegratorPtr integrator = make(problem, solver);
    const testing::StartState start = noise_state(problem, ++seed, 0.3);
    ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 20).ok());
    ASSERT_TRUE(run(*integrator, 20).ok());
    EXPECT_NEAR(problem.mass(integrator->state()) / problem.mass(start.y), 1, 1e-12) << solver;
  }
}

TEST_P(IntegratorContract, SolversGiveTheSameTrajectory) {
  IntegratorSettings settings;
  settings.linear_tolerance = 1e-10;
  const IntegratorPtr block =
      started(problem, 5, backends::choose_linear_solver("block", *space), settings);
  const IntegratorPtr direct =
      started(problem, 5, backends::choose_linear_solver("direct", *space), settings);
  ASSERT_TRUE(run(*block, 5).ok());
  ASSERT_TRUE(run(*direct, 5).ok());
  EXPECT_LT(problem.norm(block->state() - direct->state()), 1e-6);
}

TEST_P(IntegratorContract, InterpolatesItsLastStepWithoutLosingMass) {
  const IntegratorPtr integrator =
      started(problem, 1e6, backends::choose_linear_solver("block", *space));
  const double mass = problem.mass(integrator->state());
  Vec before = integrator->state(), y(problem.size());
  std::vector<double> ends = {0};
  for (int step = 0; step < 30; ++step) {
    ASSERT_TRUE(integrator->advance().ok());
    const double t1 = integrator->time(), t0 = t1 - integrator->step();
    ASSERT_TRUE(integrator->interpolate(t1, y).ok());
    EXPECT_EQ(y, integrator->state());
    ASSERT_TRUE(integrator->interpolate(t0 + 1e-12 * (t1 - t0), y).ok());
    EXPECT_LT(problem.norm(y - before), 1e-9);
    ASSERT_TRUE(integrator->interpolate(t0 + 0.4 * (t1 - t0), y).ok());
    EXPECT_NEAR(problem.mass(y) / mass, 1, 1e-13);
    // Rounding of t1 − t0 does not matter.
    ASSERT_TRUE(integrator->interpolate(std::nextafter(ends.back(), t1), y).ok());
    ends.push_back(t1);
    EXPECT_FALSE(integrator->interpolate(t1 + integrator->step(), y).ok());
    EXPECT_FALSE(integrator->interpolate(t0 - integrator->step(), y).ok());
    before = integrator->state();
  }
}

TEST_P(IntegratorContract, ContinuesBitwiseFromWhatItSaved) {
  for (const std::string& solver : backends::built_linear_solvers()) {
    const IntegratorPtr whole =
        started(problem, 300, backends::choose_linear_solver(solver, *space));
    std::vector<std::string> saved;
    for (int step = 0; step < 25; ++step) {
      std::ostringstream out;
      whole->save(out);
      saved.push_back(out.str());
      ASSERT_TRUE(whole->advance().ok());
    }
    const Vec expected = whole->state();
    for (const int step : {0, 1, 2, 3, 11, 24}) {
      const IntegratorPtr resumed = make(problem, solver);
      std::istringstream in(saved[step]);
      resumed->load(in);
      for (int left = step; left < 25; ++left) ASSERT_TRUE(resumed->advance().ok());
      EXPECT_EQ(resumed->time(), whole->time());
      EXPECT_EQ(resumed->state(), expected) << solver << " from step " << step;
      EXPECT_EQ(resumed->linear_statistics().iterations, whole->linear_statistics().iterations);
    }
  }
}

TEST_P(IntegratorContract, TheEnergyGuardContinuesBitwise) {
  const problem::CahnHilliard model(space, make_model("degenerate", 0.1));
  IntegratorSettings settings;
  settings.reject_energy_rises = true;
  settings.tolerance = 0.3;
  const testing::StartState start = noise_state(model, 1, 0.4);
  const IntegratorPtr whole = make(model, "block", settings);
  ASSERT_TRUE(whole->start(0, start.y, start.ydot, 1000).ok());
  std::vector<std::string> saved;
  while (whole->time() < 1000) {
    std::ostringstream out;
    whole->save(out);
    saved.push_back(out.str());
    ASSERT_TRUE(whole->advance().ok());
  }
  ASSERT_GT(whole->statistics().energy_rises, 0);
  for (std::size_t step = 0; step < saved.size(); step += 5) {
    const IntegratorPtr resumed = make(model, "block", settings);
    std::istringstream in(saved[step]);
    resumed->load(in);
    while (resumed->time() < 1000) ASSERT_TRUE(resumed->advance().ok());
    EXPECT_EQ(resumed->state(), whole->state()) << "from step " << step;
    EXPECT_EQ(resumed->statistics().energy_rises, whole->statistics().energy_rises);
  }
}

TEST_P(IntegratorContract, RefusesDataThatAreNotItsOwn) {
  const IntegratorPtr integrator =
      started(problem, 3, backends::choose_linear_solver("block", *space));
  ASSERT_TRUE(integrator->advance().ok());
  std::ostringstream out;
  integrator->save(out);
  const std::string data = out.str();
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{5}, data.size() / 2, data.size() - 1}) {
    std::istringstream torn(data.substr(0, size));
    EXPECT_THROW(make(problem, "block")->load(torn), IoError) << size;
  }
  const problem::CahnHilliard other(make_space(16), make_model());
  std::istringstream in(data);
  const IntegratorPtr larger =
      backends::integrators()
          .find(GetParam())
          .make(other, backends::choose_linear_solver("block", other.space()), other.space().team,
                {});
  EXPECT_THROW(larger->load(in), IoError);
}

TEST_P(IntegratorContract, RenewsFactorsBeforeItFallsBack) {
  Faulty::Plan plan;
  plan.lazy = true;  // old factors until they fail
  plan.solve_fails = [](long call) { return call % 7 == 5; };
  const IntegratorPtr integrator = started(problem, 2, faulty(plan, true));
  ASSERT_TRUE(run(*integrator, 2).ok());
  EXPECT_GT(integrator->statistics().renewals, 0);
  EXPECT_EQ(integrator->statistics().fallbacks, 0);
  EXPECT_EQ(integrator->statistics().failures, 0);
}

TEST_P(IntegratorContract, FallsBackAndStaysRight) {
  IntegratorSettings settings;
  settings.linear_tolerance = 1e-10;
  const IntegratorPtr good =
      started(problem, 2, backends::choose_linear_solver("block", *space), settings);
  ASSERT_TRUE(run(*good, 2).ok());
  for (const bool setup : {true, false}) {
    Faulty::Plan plan;
    (setup ? plan.setup_fails : plan.solve_fails) = [](long) { return true; };
    const IntegratorPtr integrator = started(problem, 2, faulty(plan, true), settings);
    ASSERT_TRUE(run(*integrator, 2).ok());
    const IntegratorStatistics statistics = integrator->statistics();
    EXPECT_GT(statistics.fallbacks, 0);
    EXPECT_EQ(statistics.fallbacks, integrator->linear_statistics().solves);  // every one
    EXPECT_LT(problem.norm(integrator->state() - good->state()), 1e-6);
  }
}

TEST_P(IntegratorContract, EndsWhenNoSolverWorksAndKeepsTheLastState) {
  Faulty::Plan plan;
  plan.solve_fails = [](long call) { return call >= 20; };
  const IntegratorPtr integrator = started(problem, 2, faulty(plan, false));
  const Status status = run(*integrator, 2);
  EXPECT_EQ(status.outcome, Outcome::fatal);
  EXPECT_NE(status.why.find("injected solve failure"), std::string::npos) << status.why;
  EXPECT_GT(integrator->statistics().failures, 0);
  EXPECT_GT(integrator->statistics().steps, 0);
  EXPECT_TRUE(integrator->state().allFinite());
}

TEST_P(IntegratorContract, CutsTheStepWhenTheModelFailsAndEndsWhenItAlwaysFails) {
  for (const bool silent : {false, true})
    for (const std::string& solver : backends::built_linear_solvers()) {
      Poisoned late(problem, [](double t) { return t > 0.5; });
      late.silent = silent;
      const IntegratorPtr integrator =
          started(late, 2, backends::choose_linear_solver(solver, *space));
      const Status status = run(*integrator, 2);
      EXPECT_EQ(status.outcome, Outcome::fatal);
      EXPECT_NE(status.why.find("no step size"), std::string::npos) << status.why;
      if (!silent) {
        EXPECT_NE(status.why.find("injected failure"), std::string::npos) << status.why;
      }
      EXPECT_LE(integrator->time(), 0.5);
      EXPECT_GT(integrator->time(), 0.49);
      EXPECT_TRUE(integrator->state().allFinite());
    }
}

TEST_P(IntegratorContract, ReportsAStepSizeThatCollapses) {
  IntegratorSettings settings;
  settings.tolerance = 1e-9;
  settings.min_step = 0.01;  // far too large for that tolerance
  const IntegratorPtr integrator =
      started(problem, 2, backends::choose_linear_solver("block", *space), settings);
  const Status status = run(*integrator, 2);
  EXPECT_EQ(status.outcome, Outcome::fatal);
  EXPECT_NE(status.why.find("no step size"), std::string::npos) << status.why;
  EXPECT_EQ(integrator->statistics().steps, 0) << "a step above the tolerance was accepted";
}

TEST_P(IntegratorContract, SaysThatTheErrorIsWhyThereIsNoStepSize) {
  // Nearly linear, so that Newton's method is not what fails.
  const problem::CahnHilliard gentle(space, make_model("constant", 0.2));
  const int n = gentle.block_size();
  Vec y = Vec::Zero(2 * n), ydot = y;
  y.head(n) = Vec::Constant(n, 0.5) + 1e-3 * noise_state(problem).y.head(n);
  ASSERT_TRUE(gentle.consistent_initial_state(0, y, ydot).ok());
  IntegratorSettings settings;
  settings.tolerance = 1e-7;
  settings.linear_tolerance = 1e-8;
  settings.initial_step = settings.min_step = 0.02;
  const IntegratorPtr integrator = make(gentle, "direct", settings);
  ASSERT_TRUE(integrator->start(0, y, ydot, 2).ok());
  const Status status = run(*integrator, 2);
  EXPECT_EQ(status.outcome, Outcome::fatal);
  EXPECT_NE(status.why.find("the error stays above the tolerance"), std::string::npos)
      << status.why;
}

// Near equilibrium energies are roundoff of terms that cancel.
TEST_P(IntegratorContract, TheEnergyGuardDoesNotMistakeRoundoffForGrowth) {
  IntegratorSettings settings;
  settings.reject_energy_rises = true;
  const IntegratorPtr integrator = make(problem, "block", settings);
  Vec y = Vec::Ones(problem.size()), ydot = Vec::Zero(problem.size());
  y.head(problem.block_size()) += 1e-9 * noise_state(problem).y.head(problem.block_size());
  ASSERT_TRUE(problem.consistent_initial_state(0, y, ydot).ok());
  ASSERT_TRUE(integrator->start(0, y, ydot, 10).ok());
  const Status status = run(*integrator, 10);
  EXPECT_TRUE(status.ok()) << status.why;
}

TEST_P(IntegratorContract, TighterTolerancesGiveSmallerErrors) {
  std::vector<Vec> states;
  for (const double tolerance : {1e-2, 1e-3, 1e-5}) {
    IntegratorSettings settings;
    settings.tolerance = tolerance;
    settings.linear_tolerance = 1e-8;
    const IntegratorPtr integrator =
        started(problem, 1, backends::choose_linear_solver("block", *space), settings);
    ASSERT_TRUE(run(*integrator, 1).ok());
    states.push_back(integrator->state());
  }
  const double loose = problem.norm(states[0] - states[2]);
  const double tight = problem.norm(states[1] - states[2]);
  EXPECT_LT(tight, 0.5 * loose);
  EXPECT_LT(tight, 5e-3 * problem.norm(states[2]));
}

TEST_P(IntegratorContract, RefusesStepsThatGainEnergyIfAskedTo) {
  // Steps far too large: without the guard the energy does grow.
  long gained[2] = {0, 0}, refused[2] = {0, 0};
  for (const bool reject : {false, true})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const problem::CahnHilliard model(space, make_model("degenerate", 0.1));
      IntegratorSettings settings;
      settings.reject_energy_rises = reject;
      settings.tolerance = 0.3;
      const IntegratorPtr integrator = make(model, "block", settings);
      const testing::StartState start = noise_state(model, seed, 0.4);
      ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 1000).ok());
      const double scale = model.energy(start.y);
      double energy = scale;
      while (integrator->time() < 1000) {
        const Status status = integrator->advance();
        ASSERT_TRUE(status.ok()) << status.why;
        const double next = model.energy(integrator->state());
        gained[reject] += next > energy + 1e-10 * scale;
        energy = next;
      }
      refused[reject] += integrator->statistics().energy_rises;
    }
  EXPECT_GT(gained[0], 0) << "the test is too gentle to need a guard";
  EXPECT_EQ(refused[0], 0);
  EXPECT_EQ(gained[1], 0);
  EXPECT_GT(refused[1], 0);
}

INSTANTIATE_TEST_SUITE_P(All, IntegratorContract,
                         ::testing::ValuesIn(backends::integrators().names()));

}  // namespace
}  // namespace traceraft::time
