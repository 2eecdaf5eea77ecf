// The potential of averaged square roots: a boundary has its line tension wherever it lies.
#include "kernel/fem/averaged_potential.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/support/dense.hpp"
#include "tests/support/relaxed_boundary.hpp"

namespace traceraft::fem {
namespace {

using testing::make_model;
using testing::make_space;
using testing::random_direction;
using testing::relaxed_boundary;

constexpr double kHOverEpsilon = 2.6;  // as in the paper

struct Sample {
  double mean = 0, scatter = 0;
};

// Energy of the boundary between two equal halves over that of a sharp one, minus 1, on meshes and
// along axes that are drawn.
Sample excess_energy(PotentialRule rule) {
  constexpr int kCuts = 16, kCells = 32;
  std::vector<double> excess;
  for (std::uint64_t cut = 0; cut < kCuts; ++cut) {
    const double h = 10.0 / 3 / kCells;
    const Point offset = 0.5 * h * random_direction(5, cut);
    const auto space = make_space(kCells, "sphere", 1, offset);
    problem::CahnHilliardModel model = make_model("constant:value=0.25", h / kHOverEpsilon);
    model.rule = rule;
    const problem::CahnHilliard problem(space, model);
    Vec y = Vec::Zero(problem.size());
    y.head(space->nodes()) = relaxed_boundary(*space, model, random_direction(6, cut));
    // On the sphere of the mesh's area, ∫ cos(s) over the profile: 1 − (π²/3 − 2) ε².
    const double length = 2 * kPi * std::sqrt(space->area / (4 * kPi));
    const double curved = 1 - (kPi * kPi / 3 - 2) * model.epsilon * model.epsilon;
    excess.push_back(
        problem.energy(y) / (model.epsilon * model.well.interface_energy() * length * curved) - 1);
  }
  Sample sample;
  for (const double each : excess) sample.mean += each / kCuts;
  for (const double each : excess) sample.scatter += std::pow(each - sample.mean, 2) / kCuts;
  sample.scatter = std::sqrt(sample.scatter);
  return sample;
}

TEST(AveragedPotential, GivesABoundaryItsLineTensionWhereverItLies) {
  const Sample averaged = excess_energy(PotentialRule::averaged);
  const Sample consistent = excess_energy(PotentialRule::consistent);
  EXPECT_LT(std::fabs(averaged.mean), 0.005);
  EXPECT_GT(consistent.mean, 0.01);
  EXPECT_LT(averaged.scatter, 0.6 * consistent.scatter);
}

// Where c is constant it is f0 itself.
TEST(AveragedPotential, IsTheDensityOfAConstant) {
  const auto space = make_space(12);
  const physics::DoubleWell well{0.7, -0.3, 1.1};
  for (const double c : {-0.5, -0.3, 0.2, 0.4, 1.3}) {
    const double energy =
        averaged_potential::energy(*space, well, Vec::Constant(space->nodes(), c));
    EXPECT_NEAR(energy, space->area * well.energy(c), 1e-12);
  }
}

// The energy of a pure phase is a minimum, although elements are many times as long as ε.
TEST(AveragedPotential, KeepsAPureOneStableOnLargeElements) {
  const geometry::LevelSetPtr surface = geometry::make_surface("sphere");
  const mesh::RefinementLevels levels{64, 2};
  const auto space = std::make_shared<SurfaceSpace>(
      surface, mesh::build_active_mesh(*surface, mesh::RefinementForest(*surface, levels, 0)),
      std::make_shared<ThreadTeam>(1), std::make_shared<SerialCommunicator>());
  const problem::CahnHilliardModel model =
      make_model("degenerate", space->h() / kHOverEpsilon);  // 10 ε to the edge, and longer
  for (const double phase : {model.well.a, model.well.b}) {
    CsrMatrix second = problem::gradient_energy_matrix(*space, model);
    add_potential_tangent(*space, model.well, PotentialRule::averaged, 1,
                          Vec::Constant(space->nodes(), phase), second);
    const Eigen::LLT<Eigen::MatrixXd> factor(testing::dense(second));
    EXPECT_EQ(factor.info(), Eigen::Success) << phase;
  }
}

}  // namespace
}  // namespace traceraft::fem
