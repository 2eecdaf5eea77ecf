// Integrators go on across meshes that follow the boundaries.
#include "kernel/simulation/mesh_adaptation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "backends/list.hpp"
#include "kernel/problem/initial_data.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::simulation {
namespace {

constexpr mesh::RefinementLevels kLevels{48, 1};
constexpr double kEnd = 200;

class MeshAdaptationContract : public ::testing::TestWithParam<std::string> {
 protected:
  std::shared_ptr<const fem::SurfaceSpace> space_on(const mesh::RefinementForest& forest) const {
    return std::make_shared<const fem::SurfaceSpace>(surface_,
                                                     mesh::build_active_mesh(*surface_, forest),
                                                     team_, std::make_shared<SerialCommunicator>());
  }
  MeshAdaptation::MakeRest make_rest() const {
    return [this](std::shared_ptr<const fem::SurfaceSpace> space) {
      time::IntegratorSettings settings;
      const backends::IntegratorEntry& entry = backends::integrators().find(GetParam());
      settings.tolerance = entry.tolerance;
      for (const ParameterSpec& parameter : entry.parameters)
        settings.method_options[parameter.name] = parameter.default_value;
      Discretisation on;
      on.problem =
          std::make_unique<problem::CahnHilliard>(space, testing::make_model("degenerate", 0.08));
      on.observer = std::make_unique<observables::Observer>(*on.problem, space, 1.0);
      on.integrator =
          entry.make(*on.problem, backends::choose_linear_solver("block", *space), team_, settings);
      on.space = std::move(space);
      return on;
    };
  }
  MeshAdaptation adaptation(mesh::RefinementForest forest) const {
    return {std::move(forest), {0.06, 0.08, kLevels.finest_generation()}, make_rest()};
  }
  // Two rafts on the finest mesh.
  Discretisation started(const mesh::RefinementForest& forest) const {
    Discretisation on = make_rest()(space_on(forest));
    problem::InitialRequest request;
    request.caps = {{{0, 0, 1}, 0.6}, {{0, 0, -1}, 0.45}};
    request.epsilon = 0.08;
    Vec y(on.problem->size()), ydot(on.problem->size());
    y.head(on.problem->block_size()) = problem::make_initial_field("caps", *on.space, request);
    EXPECT_TRUE(on.problem->consistent_initial_state(0, y, ydot).ok());
    EXPECT_TRUE(on.integrator->start(0, y, ydot, kEnd).ok());
    return on;
  }

  const geometry::LevelSetPtr surface_ = geometry::make_surface("sphere");
  const std::shared_ptr<const ThreadTeam> team_ = std::make_shared<ThreadTeam>(1);
  const mesh::RefinementForest finest_{*surface_, kLevels, kLevels.finest_generation()};
};

TEST_P(MeshAdaptationContract, KeepsMassStepsAndTheFallOfEnergy) {
  MeshAdaptation adaptation = this->adaptation(finest_);
  Discretisation on = started(finest_);
  const double mass = on.problem->mass(on.integrator->state());
  const int finest = on.space->nodes();
  double step_before = 0;
  int since = -1;
  for (int k = 0; k < 40; ++k) {
    const long remeshes = adaptation.statistics().remeshes;
    const double step = on.integrator->step();
    ASSERT_TRUE(adaptation.before_step(on).ok());
    if (adaptation.statistics().remeshes > remeshes) {
      step_before = step;
      since = 0;
    }
    const double energy = on.problem->energy(on.integrator->state());
    ASSERT_TRUE(on.integrator->advance().ok());
    const Vec& y = on.integrator->state();
    ASSERT_EQ(y.size(), 2 * on.space->nodes());
    EXPECT_NEAR(on.problem->mass(y) / mass, 1, 1e-12);
    EXPECT_LT(on.problem->energy(y), energy * (1 + 1e-6));
    if (since >= 0 && ++since == 2) {
      EXPECT_GT(on.integrator->step(), 0.5 * step_before);
    }
  }
  const RemeshStatistics& statistics = adaptation.statistics();
  EXPECT_GE(statistics.remeshes, 1);
  EXPECT_LT(on.space->nodes(), 0.8 * finest);
  EXPECT_LT(std::max(statistics.highest_jump, -statistics.lowest_jump), 1e-3);
  EXPECT_EQ(on.integrator->statistics().steps, 40);
}

TEST_P(MeshAdaptationContract, GoesOnBitwiseFromWhatItSaved) {
  MeshAdaptation whole = adaptation(finest_);
  Discretisation on = started(finest_);
  std::stringstream saved;
  std::vector<bool> bits;
  for (int k = 0; k < 30; ++k) {
    if (k == 17) {
      ASSERT_GE(whole.statistics().remeshes, 1);
      bits = whole.forest().bits();
      whole.save(CheckpointOut(saved));
      on.integrator->save(CheckpointOut(saved));
    }
    ASSERT_TRUE(whole.before_step(on).ok());
    ASSERT_TRUE(on.integrator->advance().ok());
  }
  const mesh::RefinementForest forest(*surface_, kLevels, bits);
  Discretisation again = make_rest()(space_on(forest));
  MeshAdaptation second = adaptation(forest);
  second.load(CheckpointIn(saved));
  again.integrator->load(CheckpointIn(saved));
  for (int k = 17; k < 30; ++k) {
    ASSERT_TRUE(second.before_step(again).ok());
    ASSERT_TRUE(again.integrator->advance().ok());
  }
  EXPECT_EQ(again.integrator->time(), on.integrator->time());
  EXPECT_EQ(again.integrator->state(), on.integrator->state());
  EXPECT_EQ(second.statistics().remeshes, whole.statistics().remeshes);
}

// Values off the surface are data: a transfer that replaces them multiplies the dissipation by
// hundreds, and steps collapse.
TEST_P(MeshAdaptationContract, HardlyChangesTheDissipation) {
  MeshAdaptation adaptation = this->adaptation(finest_);
  Discretisation on = started(finest_);
  const auto dissipation = [&] {
    Vec ydot(on.problem->size());
    Vec y = on.integrator->state();
    EXPECT_TRUE(on.problem->consistent_initial_state(0, y, ydot).ok());
    const auto mu = on.problem->mu_of(y);
    return on.space->bilinear(on.space->stabilised_mass, mu, ydot.head(on.space->nodes()));
  };
  for (int k = 0; adaptation.statistics().remeshes == 0 && k < 40; ++k) {
    const double before = dissipation();
    ASSERT_TRUE(adaptation.before_step(on).ok());
    if (adaptation.statistics().remeshes > 0)
      EXPECT_LT(dissipation() / before, 3);
    else
      ASSERT_TRUE(on.integrator->advance().ok());
  }
  EXPECT_EQ(adaptation.statistics().remeshes, 1);
}

// Along normals c relaxes at a rate that goes with the gradient energy over M̃. It must not fall as
// tetrahedra grow, or c wanders off the surface there.
TEST(GradientEnergyTest, HoldsNormalsOfLargeTetrahedraAsFirmly) {
  const geometry::LevelSetPtr surface = geometry::make_surface("sphere");
  const mesh::RefinementLevels levels{64, 2};
  const auto rate = [&](int generation) {
    const fem::SurfaceSpace space(
        surface,
        mesh::build_active_mesh(*surface, mesh::RefinementForest(*surface, levels, generation)),
        std::make_shared<ThreadTeam>(1), std::make_shared<SerialCommunicator>());
    Vec distance(space.nodes());
    for (int i = 0; i < space.nodes(); ++i) distance[i] = surface->value(space.mesh.position(i));
    const problem::CahnHilliardModel model = testing::make_model("degenerate", 0.08);
    return space.quadratic(problem::gradient_energy_matrix(space, model), distance) /
           space.quadratic(space.stabilised_mass, distance);
  };
  EXPECT_GT(rate(0), rate(levels.finest_generation()));
}

INSTANTIATE_TEST_SUITE_P(Integrators, MeshAdaptationContract,
                         ::testing::ValuesIn(backends::integrators().names()));

}  // namespace
}  // namespace traceraft::simulation
