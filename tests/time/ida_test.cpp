// The behaviour of IDA alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "backends/list.hpp"
#include "kernel/core/error.hpp"
#include "tests/support/forwarding.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::time {
namespace {

using testing::make_model;
using testing::make_space;
using testing::noise_state;

TEST(Ida, RefusesTheMemoryOfAnotherVersion) {
  const auto space = make_space(8);
  const problem::CahnHilliard problem(space, make_model());
  const auto make = [&] {
    return backends::integrators().find("ida").make(
        problem, backends::choose_linear_solver("direct", *space), space->team, {});
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
    Watching(linear::LinearSolverPtr inner, std::vector<double>& asked)
        : ForwardingSolver(std::move(inner)), asked_(asked) {}
    linear::SolveReport solve(const linear::BlockJacobian& J, VecView b, VecRef x, double tolerance,
                              int lane) override {
      asked_.push_back(tolerance);
      return ForwardingSolver::solve(J, b, x, tolerance, lane);
    }

   private:
    std::vector<double>& asked_;
  };
  const auto space = make_space(8);
  const problem::CahnHilliard problem(space, make_model());
  std::vector<double> asked;
  linear::LinearSolverChoice choice = backends::choose_linear_solver("block", *space);
  const linear::LinearSolverFactory inner = choice.primary;
  choice.primary = [&](int lanes) { return std::make_unique<Watching>(inner(lanes), asked); };
  const IntegratorPtr integrator =
      backends::integrators().find("ida").make(problem, choice, space->team, {});
  const testing::StartState start = noise_state(problem);
  ASSERT_TRUE(integrator->start(0, start.y, start.ydot, 5).ok());
  while (integrator->time() < 5) ASSERT_TRUE(integrator->advance().ok());
  const auto times = [&](double tolerance) {
    return std::count(asked.begin(), asked.end(), tolerance);
  };
  EXPECT_GT(times(0.05), 0);
  EXPECT_GT(times(0.5), 0);
  EXPECT_EQ(times(0.05) + times(0.5), static_cast<long>(asked.size()));
}

}  // namespace
}  // namespace traceraft::time
