#include "kernel/observables/rafts.hpp"

#include <gtest/gtest.h>

#include "backends/list.hpp"
#include "kernel/fem/trace.hpp"
#include "kernel/observables/observables.hpp"
#include "kernel/observables/resolved_boundary.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::observables {
namespace {

using testing::make_space;

Vec nodal(const fem::SurfaceSpace& space, const std::function<double(const Point&)>& f) {
  Vec c(space.nodes());
  for (int i = 0; i < space.nodes(); ++i) c[i] = f(space.mesh.position(i));
  return c;
}

TEST(Rafts, OfALinearFieldAreExactOnThePolyhedron) {
  // {z > 0.3} on the sphere: a cap of height 0.7 and a circle of radius √(1 − 0.09).
  const auto space = make_space(64);
  const RaftReport report =
      RaftFinder(space).find(nodal(*space, [](const Point& x) { return x[2] + 0.2; }), 0.5);
  ASSERT_EQ(report.rafts.size(), 1u);
  EXPECT_NEAR(report.area, 2 * M_PI * 0.7, 4e-3);
  EXPECT_NEAR(report.perimeter, 2 * M_PI * std::sqrt(1 - 0.09), 4e-3);
  EXPECT_NEAR(report.c_max, 1.2, 1e-3);
  EXPECT_NEAR(report.c_min, -0.8, 1e-3);
}

TEST(Rafts, AreCountedAndSorted) {
  const auto space = make_space(48);
  // Eight octants, of which those with xyz > 0 are rafts: four of them.
  const RaftReport report = RaftFinder(space).find(
      nodal(*space, [](const Point& x) { return 0.45 + x[0] * x[1] * x[2]; }), 0.5);
  ASSERT_EQ(report.rafts.size(), 4u);
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_GT(report.rafts[i].centre.prod(), 0.15);
    if (i > 0) {
      EXPECT_LE(report.rafts[i].area, (1 + 1e-8) * report.rafts[i - 1].area);
    }
    area += report.rafts[i].area;
  }
  EXPECT_NEAR(area, report.area, 1e-12);
}

// Every point of a ring is as near to its centre as the others: which one comes first is chance.
TEST(Rafts, ARingHasItsCentreInItsHole) {
  const auto space = make_space(32);
  for (const double lift : {0.0, 1e-9, 1e-3}) {
    const RaftReport report = RaftFinder(space).find(
        nodal(*space, [=](const Point& x) { return 0.8 - std::fabs(x[2] - 0.2) + lift * x[0]; }),
        0.5);
    ASSERT_EQ(report.rafts.size(), 1u);
    // The band −0.1 < z < 0.5, whose area is spread evenly along z.
    EXPECT_LT((report.rafts[0].centre - Point(0, 0, 0.2)).norm(), 0.01) << lift;
    EXPECT_NEAR(report.rafts[0].distance, std::sqrt(1 - 0.25 + 0.09), 0.03);
  }
}

TEST(Rafts, TheNumberAtAPointIsThatOfItsRaft) {
  const auto space = make_space(32);
  const Vec c = nodal(*space, [](const Point& x) { return 0.45 + x[0] * x[1] * x[2]; });
  const RaftReport report = RaftFinder(space).find(c, 0.5);
  ASSERT_EQ(report.rafts.size(), 4u);
  const Vec value = fem::trace(*space, c);
  ASSERT_EQ(report.of_point.size(), space->surface.points.size());
  for (std::size_t p = 0; p < report.of_point.size(); ++p) {
    const int number = report.of_point[p];
    ASSERT_EQ(number > 0, value[static_cast<Eigen::Index>(p)] > 0.5);
    if (number == 0) continue;
    ASSERT_LE(number, 4);
    const Point& centre = report.rafts[static_cast<std::size_t>(number) - 1].centre;
    EXPECT_GT(space->surface.position[p].dot(centre), 0.5);
  }
}

// Islands in one raft that covers most of the surface.
TEST(Rafts, RegionsBelowAreCounted) {
  const auto space = make_space(48);
  const Vec c = nodal(*space, [](const Point& x) { return 0.55 + x[0] * x[1] * x[2]; });
  const RaftFinder finder(space);
  EXPECT_EQ(finder.find(c, 0.5).rafts.size(), 1u);
  EXPECT_EQ(finder.regions_below(c, 0.5), 4);
  EXPECT_EQ(finder.regions_below(Vec::Ones(space->nodes()), 0.5), 0);
  EXPECT_EQ(finder.regions_below(Vec::Constant(space->nodes(), 0.5), 0.5), 0);
}

TEST(Observables, DomainsAreThoseOfThePhaseThatCoversLess) {
  const auto space = make_space(48);
  const problem::CahnHilliard problem(space, testing::make_model());
  const Observer observer(problem, space, 1);
  for (const double mean : {0.45, 0.55}) {
    Vec y = Vec::Zero(problem.size());
    y.head(problem.block_size()) =
        nodal(*space, [=](const Point& x) { return mean + x[0] * x[1] * x[2]; });
    const Observables row = observer.measure(0, y);
    EXPECT_EQ(row.rafts, mean < 0.5 ? 4 : 1);
    EXPECT_EQ(row.domains, 4);
  }
}

TEST(Rafts, OfExtremeFields) {
  const auto space = make_space(16);
  const RaftFinder finder(space);
  EXPECT_EQ(finder.find(Vec::Zero(space->nodes()), 0.5).rafts.size(), 0u);
  const RaftReport all = finder.find(Vec::Ones(space->nodes()), 0.5);
  ASSERT_EQ(all.rafts.size(), 1u);
  EXPECT_NEAR(all.area, space->area, 1e-12);
  EXPECT_EQ(all.perimeter, 0);
  // Exactly on the level everywhere: not above it.
  EXPECT_EQ(finder.find(Vec::Constant(space->nodes(), 0.5), 0.5).rafts.size(), 0u);
}

TEST(Rafts, DoNotDependOnThePositionOfTheSurface) {
  for (int i = 0; i < 20; ++i) {
    const Point offset =
        0.1 * Point(uniform_random(9, 0, i), uniform_random(9, 1, i), uniform_random(9, 2, i));
    const auto space = make_space(32, "sphere", 1, offset);
    const RaftReport report = RaftFinder(space).find(
        nodal(*space, [&](const Point& x) { return (x - offset)[2] + 0.2; }), 0.5);
    ASSERT_EQ(report.rafts.size(), 1u);
    EXPECT_NEAR(report.area, 2 * M_PI * 0.7, 0.02);
    EXPECT_NEAR(report.perimeter, 2 * M_PI * std::sqrt(1 - 0.09), 0.02);
  }
}

TEST(Observables, PerimetersAgreeForAnEquilibriumProfile) {
  const auto space = make_space(96);
  const problem::CahnHilliard problem(space, testing::make_model("degenerate", 0.06));
  Vec y = Vec::Zero(problem.size());
  y.head(problem.block_size()) = nodal(*space, [](const Point& x) {
    return physics::DoubleWell{}.profile(std::acos(x[2] / x.norm()) - M_PI / 2, 0.06);
  });
  const Observables row =
      Observer(problem, space, physics::DoubleWell{}.interface_energy()).measure(1.5, y);
  EXPECT_EQ(row.t, 1.5);
  EXPECT_EQ(row.rafts, 1);
  EXPECT_NEAR(row.perimeter_level, 2 * M_PI, 0.01);
  EXPECT_NEAR(row.perimeter, 2 * M_PI, 0.1);
  EXPECT_NEAR(row.raft_fraction, 0.5, 1e-3);
  EXPECT_NEAR(row.mass, 2 * M_PI, 0.01);
  // Half of the interface energy is f0, half is gradient: E = ε · length / (6√2).
  EXPECT_NEAR(row.energy, 0.06 * 2 * M_PI / (6 * std::sqrt(2.0)), 1e-3);
}

TEST(ResolvedBoundary, DependsOnTheWidthThatTheWellMakes) {
  problem::CahnHilliardModel model = testing::make_model("degenerate", 0.02);
  const double resolved = resolved_boundary(model, 0.05).resolved;
  model.well = {4, 0.3, 0.8};  // half as wide
  model.epsilon = 0.04;
  EXPECT_DOUBLE_EQ(resolved_boundary(model, 0.05).resolved, resolved);
  EXPECT_DOUBLE_EQ(resolved_boundary(model, 0.05).interface_energy,
                   resolved * model.well.interface_energy());
}

TEST(ResolvedBoundary, ItsTableHasNoGapsAndEnds) {
  problem::CahnHilliardModel model = testing::make_model("degenerate", 1);
  double before = 1;
  for (double h = 0; h < 20; h += 0.05) {
    const double resolved = resolved_boundary(model, h).resolved;
    EXPECT_NEAR(resolved, before, 5e-4);
    before = resolved;
  }
  EXPECT_EQ(before, 1.0196);
}

}  // namespace
}  // namespace traceraft::observables
