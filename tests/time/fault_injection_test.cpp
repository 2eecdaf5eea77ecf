// A failure at any single call of the model or of the linear solver, and what becomes of the run.
#include <gtest/gtest.h>

#include <memory>

#include "backends/list.hpp"
#include "tests/support/forwarding.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::time {
namespace {

using testing::make_model;
using testing::make_space;
using testing::noise_state;

enum class Site { residual, silent_residual, jacobian, setup, solve, silent_solve };
constexpr Site kSites[] = {Site::residual, Site::silent_residual, Site::jacobian,
                           Site::setup,    Site::solve,           Site::silent_solve};

// The calls of a site that fail: those in [first, last].
struct Fault {
  Site site;
  long first, last;
  long calls = 0;

  bool strikes(Site at) {
    if (at != site) return false;
    const long call = calls++;
    return call >= first && call <= last;
  }
};

class FaultyProblem final : public testing::ForwardingProblem {
 public:
  FaultyProblem(const problem::DaeProblem& inner, Fault& fault)
      : ForwardingProblem(inner), fault_(fault) {}
  Status residual(double t, VecView y, VecView ydot, VecRef r) const override {
    if (fault_.strikes(Site::residual)) return Status::retry("injected failure");
    const Status status = ForwardingProblem::residual(t, y, ydot, r);
    if (fault_.strikes(Site::silent_residual)) r[r.size() / 3] = std::nan("");
    return status;
  }
  Status jacobian(double t, VecView y, VecView ydot, double shift, linear::Tangent tangent,
                  linear::BlockJacobian& J) const override {
    if (fault_.strikes(Site::jacobian)) return Status::retry("injected failure");
    return ForwardingProblem::jacobian(t, y, ydot, shift, tangent, J);
  }

 private:
  Fault& fault_;
};

class FaultySolver final : public testing::ForwardingSolver {
 public:
  FaultySolver(linear::LinearSolverPtr inner, Fault& fault)
      : ForwardingSolver(std::move(inner)), fault_(fault) {}
  Status setup(const linear::BlockJacobian& J, int lane) override {
    if (fault_.strikes(Site::setup)) return Status::retry("injected failure");
    return ForwardingSolver::setup(J, lane);
  }
  linear::SolveReport solve(const linear::BlockJacobian& J, VecView b, VecRef x, double tolerance,
                            int lane) override {
    if (fault_.strikes(Site::solve)) {
      x.setConstant(1e68);  // as a failed solve may leave anything behind
      return {Status::retry("injected failure"), 3};
    }
    const linear::SolveReport report = ForwardingSolver::solve(J, b, x, tolerance, lane);
    // A solver that breaks its contract is caught as long as what it returns is no number.
    if (fault_.strikes(Site::silent_solve)) x[x.size() / 3] = std::nan("");
    return report;
  }

 private:
  Fault& fault_;
};

class FaultInjection : public ::testing::TestWithParam<std::string> {
 protected:
  static constexpr double kEnd = 0.3;
  FaultInjection() : space(make_space(8)), problem(space, make_model()) {}

  struct Outcome {
    Status status;
    Vec state;
    IntegratorStatistics statistics;
  };
  Outcome run(Fault& fault, bool with_fallback) const {
    const FaultyProblem faulty(problem, fault);
    linear::LinearSolverChoice choice = backends::choose_linear_solver("block", *space);
    choice.primary = [inner = choice.primary, &fault](int lanes) {
      return std::make_unique<FaultySolver>(inner(lanes), fault);
    };
    if (!with_fallback) choice.fallback = nullptr;
    IntegratorSettings settings;
    settings.tolerance = 1e-2;
    settings.linear_tolerance = 1e-6;
    const IntegratorPtr integrator =
        backends::integrators().find(GetParam()).make(faulty, choice, space->team, settings);
    const testing::StartState start = noise_state(problem);
    Status status = integrator->start(0, start.y, start.ydot, kEnd);
    while (status.ok() && integrator->time() < kEnd) status = integrator->advance();
    return {status, integrator->state(), integrator->statistics()};
  }

  std::shared_ptr<const fem::SurfaceSpace> space;
  problem::CahnHilliard problem;
};

TEST_P(FaultInjection, OneFailureAtAnyCallChangesNothingButTheSteps) {
  Fault none{Site::residual, 1, 0};
  const Outcome good = run(none, false);
  ASSERT_TRUE(good.status.ok());
  for (const Site site : kSites) {
    long call = 0;
    for (; call < 400; call += 1 + call / 4) {
      Fault fault{site, call, call};
      const Outcome outcome = run(fault, false);
      if (fault.calls <= call) break;  // the run has fewer calls than that
      SCOPED_TRACE("site " + std::to_string(static_cast<int>(site)) + ", call " +
                   std::to_string(call));
      ASSERT_TRUE(outcome.status.ok()) << outcome.status.why;
      const auto noticed = [](const IntegratorStatistics& s) {
        return s.failures + s.rejected + s.renewals;
      };
      EXPECT_GT(noticed(outcome.statistics), noticed(good.statistics)) << "it went unnoticed";
      EXPECT_LT(problem.norm(outcome.state - good.state), 0.05 * problem.norm(good.state));
      EXPECT_NEAR(problem.mass(outcome.state) / problem.mass(good.state), 1, 1e-12);
    }
    EXPECT_GT(call, 0) << "site " << static_cast<int>(site) << " is never called";
  }
}

TEST_P(FaultInjection, FailuresWithoutEndEndTheRunAtItsLastState) {
  for (const Site site : kSites) {
    int struck = 0;
    for (const long first : {0L, 1L, 2L, 7L}) {
      Fault fault{site, first, 1L << 40};
      const Outcome outcome = run(fault, false);
      SCOPED_TRACE("site " + std::to_string(static_cast<int>(site)) + ", from call " +
                   std::to_string(first));
      if (fault.calls <= first) continue;
      ++struck;
      EXPECT_EQ(outcome.status.outcome, traceraft::Outcome::fatal);
      EXPECT_NE(outcome.status.why.find("no step size"), std::string::npos) << outcome.status.why;
      ASSERT_TRUE(outcome.state.allFinite());
      EXPECT_LT(outcome.state.cwiseAbs().maxCoeff(), 1e3);
    }
    EXPECT_GE(struck, 2) << "site " << static_cast<int>(site);
  }
}

INSTANTIATE_TEST_SUITE_P(All, FaultInjection, ::testing::ValuesIn(backends::integrators().names()));

}  // namespace
}  // namespace traceraft::time
