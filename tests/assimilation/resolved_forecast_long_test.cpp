#include <gtest/gtest.h>

#include "backends/list.hpp"
#include "tests/support/spaces.hpp"
#include "verification/assimilation/forecast/forecast.hpp"
#include "verification/assimilation/forecast/resolved_forecast.hpp"

namespace traceraft::assimilation {
namespace {

using testing::make_model;
using testing::make_space;
using testing::random_directions;

constexpr double kWidth = 0.2;

// Rafts with phase boundaries as wide as two cells at n = 16.
Vec rafts(const fem::SurfaceSpace& space) {
  Vec nodal(space.nodes());
  for (int k = 0; k < space.nodes(); ++k) {
    const Point x = space.mesh.position(k).normalized();
    nodal[k] = 0.5 + 0.45 * std::tanh((std::sin(3 * x[0] + 1) * x[1] + 0.3 * x[2]) / kWidth);
  }
  return problem::project(space, nodal);
}

double mean(const fem::SurfaceSpace& space, VecView c) {
  return space.integral(c) / space.area;
}

TEST(MeshTransfer, KeepsConstantsAndTheMeanInManyTransfers) {
  const auto coarse = make_space(16), fine = make_space(44);
  const MeshTransfer down(*fine, coarse), up(*coarse, fine);
  EXPECT_LT((down(Vec::Ones(fine->nodes())).array() - 1).abs().maxCoeff(), 1e-8);
  const Vec c = rafts(*fine);
  Vec there_and_back = c;
  for (int k = 0; k < 5; ++k) there_and_back = up(down(there_and_back));
  EXPECT_NEAR(mean(*fine, there_and_back), mean(*fine, c), 2e-4);
}

TEST(MeshTransfer, ConvergesAtOrderTwo) {
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const auto from = make_space(20 << level), to = make_space(28 << level);
    const Vec difference = MeshTransfer(*from, to)(rafts(*from)) - rafts(*to);
    error[level] = std::sqrt(to->inner(difference, difference));
  }
  EXPECT_GT(std::log2(error[0] / error[1]), 1.6);
}

class ResolvedForecastTest : public ::testing::Test {
 protected:
  static constexpr double kBegin = 0, kEnd = 0.5;

  ResolvedForecastTest() { series.snapshots.assign(2, {0, random_directions(500), {}, {}}); }

  Vec alone(const bench::SpacePtr& space) const {
    const problem::CahnHilliard problem(space, model);
    const auto on_it = [&](const problem::DaeProblem& p) { return integrator(p, *space); };
    return forecast(problem, on_it, rafts(*space), kBegin, kEnd).end;
  }

  problem::CahnHilliardModel model = make_model("degenerate", kWidth);
  FieldSeries series;
  MakeForecaster integrator = [](const problem::DaeProblem& problem,
                                 const fem::SurfaceSpace& space) {
    time::IntegratorSettings settings;
    settings.tolerance = 1e-4;
    return backends::integrators().find("ida").make(
        problem, backends::choose_linear_solver("block", space), space.team, settings);
  };
};

TEST_F(ResolvedForecastTest, LeavesLittleOfTheErrorOfTheMesh) {
  const geometry::LevelSetPtr surface = geometry::make_surface("sphere");
  const bench::SpacePtr own = serial_space(surface, 16);
  const FinerMeshes meshes = finer_meshes(surface, own, 16);
  const FinerTraces traces = finer_traces(meshes, series);
  ResolvedForecast resolved(meshes, traces, model, rafts(*meshes.spaces[1]), integrator);
  const ResolvedForecast::End end = resolved.advance(1, kBegin, kEnd);

  // On its own mesh, so that what no field on it can represent does not count.
  const bench::SpacePtr exact_space = serial_space(surface, 80);
  const Vec exact = MeshTransfer(*exact_space, own)(alone(exact_space));
  const auto norm = [&](const Vec& c) { return std::sqrt(own->inner(c, c)); };
  const double error = norm(end.field - exact);
  EXPECT_LT(error, 0.5 * norm(meshes.from_finest(alone(meshes.spaces[1])) - exact));
  EXPECT_LT(error, 0.1 * norm(alone(own) - exact));
  EXPECT_GT(norm(end.doubt), error);
}

TEST_F(ResolvedForecastTest, GoesOnFromACorrectedState) {
  const geometry::LevelSetPtr surface = geometry::make_surface("sphere");
  const bench::SpacePtr own = serial_space(surface, 16);
  const FinerMeshes meshes = finer_meshes(surface, own, 16);
  const FinerTraces traces = finer_traces(meshes, series);
  ResolvedForecast plain(meshes, traces, model, rafts(*meshes.spaces[1]), integrator),
      corrected = plain;
  corrected.correct(Vec::Constant(own->nodes(), 0.01));
  const Vec change =
      corrected.advance(1, kBegin, kEnd).field - plain.advance(1, kBegin, kEnd).field;
  EXPECT_NEAR(mean(*own, change), 0.01, 1e-5);
}

}  // namespace
}  // namespace traceraft::assimilation
