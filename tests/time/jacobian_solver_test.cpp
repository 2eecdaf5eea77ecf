#include "kernel/time/jacobian_solver.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "backends/list.hpp"
#include "tests/support/faulty.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::time {
namespace {

using testing::Faulty;
using testing::make_model;
using testing::make_space;

// Factors renewed for the second of two systems belong to that system's state, and a restart must
// compute them there again.
TEST(JacobianSolver, RemembersTheStateOfRenewedFactorsWhicheverLaneNeededThem) {
  const auto space = make_space(10);
  const problem::CahnHilliard problem(space, make_model());
  const testing::StartState start = testing::noise_state(problem);
  Faulty::Plan plan;
  plan.lazy = true;
  plan.solve_fails = [](long call) { return call == 3; };  // lane 1 in the second round
  linear::LinearSolverChoice choice = backends::choose_linear_solver("block", *space);
  choice.fallback = nullptr;
  linear::LinearSolverChoice faulty = choice;
  faulty.primary = [&](int lanes) { return std::make_unique<Faulty>(choice.primary(lanes), plan); };
  const auto systems = [&](double shift) {
    std::vector<NewtonSystem> list(2);
    for (std::size_t lane = 0; lane < 2; ++lane) {
      list[lane].shift = shift * (lane == 0 ? 1 : 30);
      list[lane].tangent = linear::Tangent::stabilised;
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

}  // namespace
}  // namespace traceraft::time
