// Runs and solves on the ranks of MPI against the same on one rank.
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "backends/list.hpp"
#include "backends/mpi/mpi_communicator.hpp"
#include "backends/ranks.hpp"
#include "tests/support/rank_contract.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft {
namespace {

using testing::make_model;
using testing::make_space;
using testing::noise_state;

std::shared_ptr<const fem::SurfaceSpace> shared_space(int cells) {
  return std::make_shared<fem::SurfaceSpace>(geometry::make_surface("sphere"), cells,
                                             std::make_shared<ThreadTeam>(1), backends::world());
}

// The entries of a state of one rank at the nodes of another space.
Vec part_of(const fem::SurfaceSpace& whole, const Vec& y, const fem::SurfaceSpace& part) {
  std::map<std::int64_t, int> number;
  for (int i = 0; i < whole.nodes(); ++i) number[whole.mesh.node_id[i]] = i;
  Vec mine(2 * part.nodes());
  for (int i = 0; i < part.nodes(); ++i) {
    const int k = number.at(part.mesh.node_id[i]);
    mine[i] = y[k];
    mine[part.nodes() + i] = y[whole.nodes() + k];
  }
  return mine;
}

TEST(Mpi, IsACommunicator) {
  testing::check_communicator(*backends::world());
}

// No two pieces of it are the same.
std::string message(int from, int to) {
  std::string text;
  for (int k = 0; text.size() < 3000000; ++k)
    text += std::to_string(from) + " to " + std::to_string(to) + ": " + std::to_string(k) + ". ";
  return text;
}

// In one piece, and in pieces.
class MpiMessages : public ::testing::TestWithParam<std::size_t> {};

INSTANTIATE_TEST_SUITE_P(Lengths, MpiMessages, ::testing::Values(std::size_t{1} << 30, 1000000));

TEST_P(MpiMessages, Arrive) {
  const auto ranks = mpi::mpi_world(GetParam());
  std::vector<std::string> to;
  for (int rank = 0; rank < ranks->size(); ++rank) to.push_back(message(ranks->rank(), rank));
  const auto from = ranks->exchange(to);
  for (int rank = 0; rank < ranks->size(); ++rank)
    EXPECT_EQ(from[rank], message(rank, ranks->rank()));
}

class OnRanks : public ::testing::Test {
 protected:
  OnRanks()
      : whole(make_space(16)),
        part(shared_space(16)),
        alone(whole, make_model("degenerate", 0.1)),
        shared(part, make_model("degenerate", 0.1)) {}

  std::shared_ptr<const fem::SurfaceSpace> whole, part;
  problem::CahnHilliard alone, shared;
};

TEST_F(OnRanks, ResidualAndJacobianAreBitwiseThose) {
  const Vec y = testing::random_state(alone, 3), ydot = testing::random_state(alone, 4),
            v = testing::random_state(alone, 5);
  const Vec mine = part_of(*whole, y, *part), my_rate = part_of(*whole, ydot, *part);
  Vec expected(alone.size()), found(shared.size());
  ASSERT_TRUE(alone.residual(0, y, ydot, expected).ok());
  ASSERT_TRUE(shared.residual(0, mine, my_rate, found).ok());
  EXPECT_EQ(found, part_of(*whole, expected, *part));
  linear::BlockJacobian J = alone.make_jacobian(), mine_J = shared.make_jacobian();
  ASSERT_TRUE(alone.jacobian(0, y, ydot, 7, linear::Tangent::exact, J).ok());
  ASSERT_TRUE(shared.jacobian(0, mine, my_rate, 7, linear::Tangent::exact, mine_J).ok());
  J.multiply(v, expected, *whole->team);
  mine_J.multiply(part_of(*whole, v, *part), found, *part->team);
  EXPECT_EQ(found, part_of(*whole, expected, *part));
}

// Every method, and every inverse in every preconditioner, finds the solution of a fixed right-hand
// side that a direct solver finds on one rank, or none.
TEST_F(OnRanks, TekoSolvesWhatADirectSolverSolvesAlone) {
  const testing::StartState start = noise_state(alone);
  const Vec b = testing::random_vector(alone.size(), 9);
  for (const double shift : {1e4, 50.0}) {
    linear::BlockJacobian J = alone.make_jacobian(), mine = shared.make_jacobian();
    ASSERT_TRUE(alone.jacobian(0, start.y, start.ydot, shift, linear::Tangent::stabilised, J).ok());
    ASSERT_TRUE(shared
                    .jacobian(0, part_of(*whole, start.y, *part), Vec::Zero(shared.size()), shift,
                              linear::Tangent::stabilised, mine)
                    .ok());
    const linear::LinearSolverPtr direct =
        backends::linear_solvers().find("direct").make(*whole, {})(1);
    Vec expected = Vec::Zero(b.size());
    ASSERT_TRUE(direct->setup(J).ok());
    ASSERT_TRUE(direct->solve(J, b, expected, 1e-12).status.ok());
    expected = part_of(*whole, expected, *part);
    const auto solve = [&](const backends::WordOptions& options, const fem::SurfaceSpace& space,
                           const linear::BlockJacobian& A, const Vec& right, Vec& x) {
      const linear::LinearSolverPtr teko =
          backends::linear_solvers().find("teko").make(space, options)(1);
      EXPECT_TRUE(teko->setup(A).ok());
      x = Vec::Zero(right.size());
      return teko->solve(A, right, x, 1e-10);
    };
    const Vec mine_b = part_of(*whole, b, *part);
    for (const std::string method : {"fgmres", "gmres", "gcrodr", "bicgstab"})
      for (const std::string inverse : {"muelu", "muelu-ilu", "ifpack2"})
        for (const std::string preconditioner : {"two-solve", "gauss-seidel", "block-lu"}) {
          if (method != "fgmres" && (inverse != "muelu" || preconditioner != "two-solve")) continue;
          const backends::WordOptions options = {
              {"method", method}, {"inverse", inverse}, {"preconditioner", preconditioner}};
          Vec x;
          const linear::SolveReport report = solve(options, *part, mine, mine_b, x);
          const std::string what = method + " " + inverse + " " + preconditioner;
          if (preconditioner == "two-solve") {
            EXPECT_TRUE(report.status.ok()) << what << ": " << report.status.why;
          }
          if (!report.status.ok()) continue;
          const double error = (x - expected).cwiseAbs().maxCoeff();
          EXPECT_LT(error, 1e-6 * expected.cwiseAbs().maxCoeff()) << what;
        }
    Vec x;
    const int on_ranks = solve({}, *part, mine, mine_b, x).iterations;
    const int on_one = solve({}, *whole, J, b, x).iterations;
    // The smoother is one of each rank's part of this small mesh.
    EXPECT_NEAR(on_ranks, on_one, backends::world()->size() < 3 ? 2 : 8) << "shift " << shift;
  }
}

TEST_F(OnRanks, SolversOfOneRankSaySo) {
  if (backends::world()->size() == 1) return;
  for (const char* name : {"block", "direct", "klu"}) try {
      (void)backends::linear_solvers().find(name).make(*part, {});
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("teko"), std::string::npos);
    }
  EXPECT_THROW((void)backends::linear_solvers().find("teko").make(*part, {{"inverse", "direct"}}),
               InputError);
}

// Trajectories are the same to the tolerance of the solvers, and what one rank saves, others go on
// with.
TEST_F(OnRanks, IntegratorsGoTheSameWayAndContinueOnOtherNumbersOfRanks) {
  time::IntegratorSettings settings;
  settings.linear_tolerance = 1e-10;
  for (const backends::IntegratorEntry& entry : backends::integrators()) {
    const auto make = [&](const problem::CahnHilliard& problem, const fem::SurfaceSpace& space) {
      return entry.make(problem, backends::choose_linear_solver("teko", space), space.team,
                        settings);
    };
    const auto run = [](time::Integrator& integrator) {
      while (integrator.time() < 2) ASSERT_TRUE(integrator.advance().ok());
    };
    const testing::StartState start = noise_state(alone), mine = noise_state(shared);
    const time::IntegratorPtr one = make(alone, *whole), many = make(shared, *part);
    ASSERT_TRUE(one->start(0, start.y, start.ydot, 2).ok());
    ASSERT_TRUE(many->start(0, mine.y, mine.ydot, 2).ok());
    for (int step = 0; step < 10; ++step) ASSERT_TRUE(many->advance().ok());
    std::ostringstream saved;
    many->save(CheckpointOut(saved, part->order));
    run(*one);
    run(*many);
    EXPECT_EQ(one->statistics().steps, many->statistics().steps) << entry.name;
    const Vec expected = part_of(*whole, one->state(), *part);
    EXPECT_LT(shared.norm(many->state() - expected), 1e-6) << entry.name;

    // From the ranks to one: the first rank has all of it.
    Lists<char> everywhere(static_cast<std::size_t>(backends::world()->size()));
    const std::string text = saved.str();
    for (auto& list : everywhere) list.assign(text.begin(), text.end());
    const std::vector<char> data = scatter(*backends::world(), everywhere);
    std::istringstream in(std::string(data.begin(), data.end()));
    const time::IntegratorPtr resumed = make(alone, *whole);
    resumed->load(in);
    run(*resumed);
    EXPECT_LT(alone.norm(resumed->state() - one->state()), 1e-6) << entry.name;
    // And back.
    std::ostringstream from_one;
    const time::IntegratorPtr again = make(alone, *whole), back = make(shared, *part);
    ASSERT_TRUE(again->start(0, start.y, start.ydot, 2).ok());
    for (int step = 0; step < 10; ++step) ASSERT_TRUE(again->advance().ok());
    again->save(from_one);
    std::istringstream to_many(from_one.str());
    back->load(CheckpointIn(to_many, part->order));
    run(*back);
    EXPECT_LT(shared.norm(back->state() - expected), 1e-6) << entry.name;
  }
}

}  // namespace
}  // namespace traceraft
