#include <gtest/gtest.h>

#include "backends/list.hpp"
#include "tests/support/small_vesicle.hpp"
#include "tests/support/spaces.hpp"
#include "verification/selection/blind/blind_simulation.hpp"

namespace traceraft::selection {
namespace {

// A truth needs more steps than a trial is allowed.
TEST(BlindSimulation, TakesAsManyStepsAsItNeeds) {
  const BlindRequest request = testing::small_vesicle(1);
  const bench::SpacePtr space = testing::make_space(8);
  const std::vector<double> times = {1e-3, 2};
  const BlindMethod method{space, "euler", 1e-8};
  const BlindSimulation truth(request, method, {});
  const std::vector<Vec> c = truth.run(times);
  EXPECT_NEAR(space->integral(c[0]), space->integral(c[1]), 1e-9);

  const problem::CahnHilliard problem(space, request.base);
  const auto euler = [&](const problem::DaeProblem& p) {
    time::IntegratorSettings settings;
    settings.tolerance = method.tolerance;
    return backends::integrators().find("euler").make(
        p, backends::choose_linear_solver("block", *space), space->team, settings);
  };
  EXPECT_THROW((void)assimilation::forecast(problem, euler, c[0], times[0], times[1]),
               std::runtime_error);
  const Vec same = assimilation::forecast(problem, euler, c[0], times[0], times[1], {}, 100000).end;
  EXPECT_LT((same - c[1]).norm(), 1e-12 * c[1].norm());
}

}  // namespace
}  // namespace traceraft::selection
