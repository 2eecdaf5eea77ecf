// What every integrator promises (kernel/time/integrator.hpp), and what it does when things fail.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <sstream>

#include "backends/list.hpp"
#include "kernel/time/jacobian_solver.hpp"
#include "tests/support/forwarding.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft {
namespace {

using testing::make_model;
using testing::make_space;
using testing::noise_state;

// A linear solver that fails on chosen calls.
class Faulty final : public testing::ForwardingSolver {
 public:
  struct Plan {
    std::function<bool(long)> setup_fails = [](long) { return false; };
    std::function<bool(long)> solve_fails = [](long) { return false; };
    bool lazy = false;  // never asks for a set-up by itself
  };
  Faulty(LinearSolverPtr inner, Plan plan)
      : ForwardingSolver(std::move(inner)), plan_(std::move(plan)) {}

  Status setup(const BlockJacobian& J, int lane) override {
    if (plan_.setup_fails(setups_++)) return Status::retry("injected set-up failure");
    return ForwardingSolver::setup(J, lane);
  }
  bool wants_setup(const BlockJacobian& J, int lane) const override {
    return !plan_.lazy && ForwardingSolver::wants_setup(J, lane);
  }
  SolveReport solve(const BlockJacobian& J, ConstVec b, VecRef x, double tolerance,
                    int lane) override {
    if (plan_.solve_fails(solves_++)) {
      x.setConstant(std::nan(""));  // as a failed solve may leave anything behind
      return {Status::retry("injected solve failure"), 3};
    }
    return ForwardingSolver::solve(J, b, x, tolerance, lane);
  }

 private:
  Plan plan_;
  long setups_ = 0, solves_ = 0;
};

// A problem whose residual is not a number from some evaluation on, or at all large steps.
class Poisoned final : public testing::ForwardingProblem {
 public:
  Poisoned(const DaeProblem& inner, std::function<bool(double)> poisoned_at)
      : ForwardingProblem(inner), poisoned_at_(std::move(poisoned_at)) {}
  Status residual(double t, ConstVec y, ConstVec ydot, VecRef r) const override {
    if (poisoned_at_(t) && !silent) return Status::retry("injected failure");
    const Status status = ForwardingProblem::residual(t, y, ydot, r);
    if (poisoned_at_(t)) r[r.size() / 3] = std::nan("");
    return status;
  }
  bool silent = false;  // a NaN that the model does not notice

 private:
  std::function<bool(double)> poisoned_at_;
};

class IntegratorContract : public ::testing::TestWithParam<std::string> {
 protected:
  // Two threads, so that the solves of a step really run at the same time.
  IntegratorContract() : space(make_space(12, "sphere", 2)), problem(space, make_model()) {}

  IntegratorPtr make(const DaeProblem& dae, const std::string& solver = "direct",
                     IntegratorSettings settings = {}) const {
    return integrators()
        .find(GetParam())
        .make(dae, choose_linear_solver(solver, *space), space->team, settings);
  }
  IntegratorPtr started(const DaeProblem& dae, double t_end, const LinearSolverChoice& choice,
                        IntegratorSettings settings = {}) const {
    IntegratorPtr integrator =
        integrators().find(GetParam()).make(dae, choice, space->team, settings);
    const testing::StartState start = noise_state(problem);
    EXPECT_TRUE(integrator->start(0, start.y, start.ydot, t_end).ok());
    return integrator;
  }
  static Status run(Integrator& integrator, double t_end) {
    Status status;
    while (status.ok() && integrator.time() < t_end) status = integrator.advance();
    return status;
  }
  LinearSolverChoice faulty(Faulty::Plan plan, bool with_fallback) const {
    LinearSolverChoice choice = choose_linear_solver("block", *space);
    LinearSolverFactory inner = choice.primary;
    choice.primary = [inner, plan](int lanes) {
      return std::make_unique<Faulty>(inner(lanes), plan);
    };
    if (!with_fallback) choice.fallback = nullptr;
    return choice;
  }

  std::shared_ptr<const SurfaceSpace> space;
  CahnHilliard problem;
};

TEST_P(IntegratorContract, EndsExactlyAtTheEndAndGoesNoFurther) {
  const IntegratorPtr integrator = started(problem, 0.7, choose_linear_solver("block", *space));
  ASSERT_TRUE(run(*integrator, 0.7).ok());
  EXPECT_EQ(integrator->time(), 0.7);
  EXPECT_EQ(integrator->advance().outcome, Outcome::fatal);
  EXPECT_EQ(integrator->time(), 0.7);
}

TEST_P(IntegratorContract, KeepsMassWithEverySolver) {
  for (const std::string& solver : built_linear_solvers())
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const IntegratorPtr integrator = make(problem, solver);
      const testing::StartState start = noise_state(problem, seed, 0.3);
      ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 20).ok());
      ASSERT_TRUE(run(*integrator, 20).ok());
      EXPECT_NEAR(problem.mass(integrator->state()) / problem.mass(start.y), 1, 1e-12) << solver;
    }
}

TEST_P(IntegratorContract, SolversGiveTheSameTrajectory) {
  IntegratorSettings settings;
  settings.linear_tolerance = 1e-10;
  const IntegratorPtr block = started(problem, 5, choose_linear_solver("block", *space), settings);
  const IntegratorPtr direct =
      started(problem, 5, choose_linear_solver("direct", *space), settings);
  ASSERT_TRUE(run(*block, 5).ok());
  ASSERT_TRUE(run(*direct, 5).ok());
  EXPECT_LT(problem.norm(block->state() - direct->state()), 1e-6);
}

TEST_P(IntegratorContract, InterpolatesItsLastStepWithoutLosingMass) {
  const IntegratorPtr integrator = started(problem, 1e6, choose_linear_solver("block", *space));
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
  for (const std::string& solver : built_linear_solvers()) {
    const IntegratorPtr whole = started(problem, 300, choose_linear_solver(solver, *space));
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
  const CahnHilliard model(space, make_model("degenerate", 0.1));
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
  const IntegratorPtr integrator = started(problem, 3, choose_linear_solver("block", *space));
  ASSERT_TRUE(integrator->advance().ok());
  std::ostringstream out;
  integrator->save(out);
  const std::string data = out.str();
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{5}, data.size() / 2, data.size() - 1}) {
    std::istringstream torn(data.substr(0, size));
    EXPECT_THROW(make(problem, "block")->load(torn), IoError) << size;
  }
  const CahnHilliard other(make_space(16), make_model());
  std::istringstream in(data);
  const IntegratorPtr larger =
      integrators()
          .find(GetParam())
          .make(other, choose_linear_solver("block", other.space()), other.space().team, {});
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
  const IntegratorPtr good = started(problem, 2, choose_linear_solver("block", *space), settings);
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
    for (const std::string& solver : built_linear_solvers()) {
      Poisoned late(problem, [](double t) { return t > 0.5; });
      late.silent = silent;
      const IntegratorPtr integrator = started(late, 2, choose_linear_solver(solver, *space));
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
      started(problem, 2, choose_linear_solver("block", *space), settings);
  const Status status = run(*integrator, 2);
  EXPECT_EQ(status.outcome, Outcome::fatal);
  EXPECT_NE(status.why.find("no step size"), std::string::npos) << status.why;
  EXPECT_EQ(integrator->statistics().steps, 0) << "a step above the tolerance was accepted";
}

TEST_P(IntegratorContract, SaysThatTheErrorIsWhyThereIsNoStepSize) {
  // Nearly linear, so that Newton's method is not what fails.
  const CahnHilliard gentle(space, make_model("constant", 0.2));
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
        started(problem, 1, choose_linear_solver("block", *space), settings);
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
      const CahnHilliard model(space, make_model("degenerate", 0.1));
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

INSTANTIATE_TEST_SUITE_P(All, IntegratorContract, ::testing::ValuesIn(integrators().names()));

TEST(Ida, RefusesTheMemoryOfAnotherVersion) {
  const auto space = make_space(8);
  const CahnHilliard problem(space, make_model());
  const auto make = [&] {
    return integrators().find("ida").make(problem, choose_linear_solver("direct", *space),
                                          space->team, {});
  };
  const testing::StartState start = noise_state(problem);
  const IntegratorPtr integrator = make();
  ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 1).ok());
  ASSERT_TRUE(integrator->advance().ok());
  std::ostringstream out;
  integrator->save(out);
  std::string data = out.str();
  const std::size_t vector = sizeof(std::int64_t) + sizeof(double) * start.y.size();
  data[6 * sizeof(double) + sizeof(long) + vector] ^= 8;  // the size of IDA's memory
  std::istringstream in(data);
  try {
    make()->load(in);
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("version"), std::string::npos) << error.what();
  }
}

// The first correction of a step decides its accuracy; later ones are small and solved loosely, but
// not at random.
TEST(Ida, SolvesEveryCorrectionAsItPromises) {
  class Watching final : public testing::ForwardingSolver {
   public:
    Watching(LinearSolverPtr inner, std::vector<double>& asked)
        : ForwardingSolver(std::move(inner)), asked_(asked) {}
    SolveReport solve(const BlockJacobian& J, ConstVec b, VecRef x, double tolerance,
                      int lane) override {
      asked_.push_back(tolerance);
      return ForwardingSolver::solve(J, b, x, tolerance, lane);
    }

   private:
    std::vector<double>& asked_;
  };
  const auto space = make_space(8);
  const CahnHilliard problem(space, make_model());
  std::vector<double> asked;
  LinearSolverChoice choice = choose_linear_solver("block", *space);
  const LinearSolverFactory inner = choice.primary;
  choice.primary = [&](int lanes) { return std::make_unique<Watching>(inner(lanes), asked); };
  const IntegratorPtr integrator = integrators().find("ida").make(problem, choice, space->team, {});
  const testing::StartState start = noise_state(problem);
  ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 5).ok());
  while (integrator->time() < 5) ASSERT_TRUE(integrator->advance().ok());
  EXPECT_GT(std::count(asked.begin(), asked.end(), 1e-2), 0);
  EXPECT_GT(std::count(asked.begin(), asked.end(), 1e-1), 0);
  EXPECT_EQ(
      std::count(asked.begin(), asked.end(), 1e-2) + std::count(asked.begin(), asked.end(), 1e-1),
      static_cast<long>(asked.size()));
}

// Factors renewed for the second of two systems belong to that system's state, and a restart must
// compute them there again.
TEST(JacobianSolver, RemembersTheStateOfRenewedFactorsWhicheverLaneNeededThem) {
  const auto space = make_space(10);
  const CahnHilliard problem(space, make_model());
  const testing::StartState start = noise_state(problem);
  Faulty::Plan plan;
  plan.lazy = true;
  plan.solve_fails = [](long call) { return call == 3; };  // lane 1 in the second round
  LinearSolverChoice choice = choose_linear_solver("block", *space);
  choice.fallback = nullptr;
  LinearSolverChoice faulty = choice;
  faulty.primary = [&](int lanes) { return std::make_unique<Faulty>(choice.primary(lanes), plan); };
  const auto systems = [&](double shift) {
    std::vector<NewtonSystem> list(2);
    for (std::size_t lane = 0; lane < 2; ++lane) {
      list[lane].shift = shift * (lane == 0 ? 1 : 30);
      list[lane].tangent = Tangent::stabilised;
      list[lane].y = (lane == 0 ? 1 : 0.7) * start.y;
      list[lane].ydot = Vec::Zero(problem.size());
      list[lane].b = testing::random_vector(problem.size(), 5 + lane);
      list[lane].x = Vec::Zero(problem.size());
    }
    return list;
  };
  JacobianSolver whole(problem, faulty, 2, space->team);
  auto first = systems(1), second = systems(2), third = systems(3);
  whole.solve(first, 1e-6);
  whole.solve(second, 1e-6);
  ASSERT_EQ(whole.statistics().renewals, 1);
  std::stringstream saved;
  whole.save(static_cast<std::ostream&>(saved));
  plan.solve_fails = [](long) { return false; };
  JacobianSolver resumed(problem, faulty, 2, space->team);
  resumed.load(static_cast<std::istream&>(saved));
  auto again = third;
  whole.solve(third, 1e-6);
  resumed.solve(again, 1e-6);
  for (std::size_t lane = 0; lane < 2; ++lane) EXPECT_EQ(third[lane].x, again[lane].x) << lane;
}

TEST(Euler, NeverGainsEnergyWhereItPromisesSo) {
  const auto space = make_space(16);
  long gained_by_second = 0;
  for (const char* kept : {"first", "decaying", "second"})
    for (const char* mobility : {"degenerate", "constant"})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const CahnHilliard problem(space, make_model(mobility, 0.1));
        IntegratorSettings settings;
        settings.kept_solution = kept;
        settings.tolerance = 0.05;  // large steps are where an unstable scheme would show
        const IntegratorPtr integrator = integrators().find("euler").make(
            problem, choose_linear_solver("block", *space), space->team, settings);
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

TEST(Euler, OneStepIsTheHandAssembledStabilisedScheme) {
  // (M̃/Δt + …): M̃ (c − c_n)/Δt + A μ = 0, M̃ μ = b(c_n) + β M̃ (c − c_n) + ε² (K + ρS) c, as one
  // dense system.
  const auto space = make_space(8);
  const CahnHilliard problem(space, make_model());
  const int n = problem.block_size();
  const testing::StartState start = noise_state(problem);
  IntegratorSettings settings;
  settings.initial_step = 1e-3;
  settings.tolerance = 0.5;
  const IntegratorPtr integrator = integrators().find("euler").make(
      problem, choose_linear_solver("direct", *space), space->team, settings);
  ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 1).ok());
  ASSERT_TRUE(integrator->advance().ok());
  ASSERT_EQ(integrator->time(), 1e-3);

  BlockJacobian J = problem.make_jacobian();
  ASSERT_TRUE(problem.jacobian(0, start.y, start.ydot, 1e3, Tangent::stabilised, J).ok());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  const SparsityPattern& p = *space->pattern;
  for (int i = 0; i < n; ++i)
    for (int k = p.row_begin[i]; k < p.row_begin[i + 1]; ++k) {
      system(i, p.column[k]) = 1e3 * space->stabilised_mass.values[k];
      system(i, n + p.column[k]) = J.cm.values[k];
      system(n + i, n + p.column[k]) = space->stabilised_mass.values[k];
      system(n + i, p.column[k]) =
          -0.04 * (space->stiffness.values[k] + space->h() * space->normal.values[k]) -
          space->stabilised_mass.values[k];
    }
  Vec right = Vec::Zero(2 * n);
  const Vec c = start.y.head(n);
  space->stabilised_mass.multiply_add(1e3, c, right.head(n), *space->team);
  add_potential(*space, problem.model().well, PotentialRule::consistent, 1, c, right.tail(n));
  space->stabilised_mass.multiply_add(-1, c, right.tail(n), *space->team);
  const Vec expected = system.partialPivLu().solve(right);
  EXPECT_LT((integrator->state() - expected).norm(), 1e-10 * expected.norm());
}

TEST(Euler, DoesNotDependOnThreads) {
  Vec states[2];
  for (const int threads : {1, 2}) {
    const auto space = make_space(12, "sphere", threads);
    const CahnHilliard problem(space, make_model());
    const testing::StartState start = noise_state(problem);
    const IntegratorPtr integrator = integrators().find("euler").make(
        problem, choose_linear_solver("block", *space), space->team, {});
    ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 1).ok());
    while (integrator->time() < 1) ASSERT_TRUE(integrator->advance().ok());
    states[threads - 1] = integrator->state();
  }
  EXPECT_EQ(states[0], states[1]);
}

}  // namespace
}  // namespace traceraft
