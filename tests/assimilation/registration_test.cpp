// Vesicles that turn between two looks at them.
#include "verification/assimilation/fields/registration.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/support/spaces.hpp"
#include "verification/assimilation/fields/mesh_transfer.hpp"

namespace traceraft::assimilation {
namespace {

using testing::make_space;

// Rafts that no rotation but one brings onto themselves.
double rafts_at(const Point& x) {
  const double level = std::sin(3 * x[0] + 1) * x[1] + 0.3 * x[2] + 0.4 * x[0] * x[1];
  return 0.5 + 0.5 * std::tanh(level / 0.15);
}

Vec rafts_on(const fem::SurfaceSpace& space) {
  Vec nodal(space.nodes());
  for (int k = 0; k < space.nodes(); ++k) nodal[k] = rafts_at(space.mesh.position(k).normalized());
  return nodal;
}

Eigen::Matrix3d turn_of(double angle) {
  return Eigen::AngleAxisd(angle, Point(1, -2, 0.5).normalized()).toRotationMatrix();
}

struct Turned {
  std::vector<Point> points;
  Vec values;

  explicit Turned(const Eigen::Matrix3d& Q, double noise = 0.1) : values(1000) {
    for (int k = 0; k < 1000; ++k) {
      points.push_back(testing::random_direction(5, static_cast<std::uint64_t>(k)));
      values[k] = 0.2 + 0.8 * rafts_at(Q.transpose() * points[k]) + noise * normal_random(5, 3, k);
    }
  }
};

TEST(Registration, FindsAnyRotation) {
  const auto space = make_space(20);
  const SphereMap before(*space, rafts_on(*space));
  for (const double angle : {0.1, 0.7, 2.0, 3.1}) {
    const Turned turned(turn_of(angle));
    const Registration found = register_values(before, turned.points, turned.values);
    ASSERT_TRUE(found.turned) << angle;
    EXPECT_LT(angle_of(found.rotation * turn_of(angle).transpose()), 0.03) << angle;
  }
}

TEST(Registration, LeavesWhatHasNotTurned) {
  const auto space = make_space(20);
  const SphereMap before(*space, rafts_on(*space));
  const Turned still(turn_of(0)), hardly(turn_of(0.02)), other(turn_of(1), 3);
  EXPECT_FALSE(register_values(before, still.points, still.values).turned);
  EXPECT_FALSE(register_values(before, hardly.points, hardly.values).turned);
  EXPECT_FALSE(
      register_values(before, other.points, other.values).turned);  // noise is like nothing
}

// Turned about its axis a cap stays as it is: what is found is how its middle has moved.
TEST(Registration, IsTheLeastOfThoseThatLookAlike) {
  const auto space = make_space(20);
  const auto cap_at = [](const Point& x) { return 0.5 + 0.5 * std::tanh((x[2] - 0.5) / 0.15); };
  Vec cap(space->nodes());
  for (int k = 0; k < space->nodes(); ++k) cap[k] = cap_at(space->mesh.position(k).normalized());
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(0.4, Point::UnitX()).toRotationMatrix();
  std::vector<Point> points;
  Vec values(1000);
  for (int k = 0; k < 1000; ++k) {
    points.push_back(testing::random_direction(5, static_cast<std::uint64_t>(k)));
    values[k] = cap_at(tilt.transpose() * points[k]) + 0.05 * normal_random(5, 4, k);
  }
  const Registration found = register_values(SphereMap(*space, cap), points, values);
  ASSERT_TRUE(found.turned);
  EXPECT_NEAR(angle_of(found.rotation), 0.4, 0.1);
  EXPECT_LT((found.rotation * Point::UnitZ() - tilt * Point::UnitZ()).norm(), 0.05);
}

TEST(Registration, IsOfSpheresAlone) {
  EXPECT_TRUE(is_sphere(*geometry::make_surface("sphere")));
  EXPECT_FALSE(is_sphere(*geometry::make_surface("ellipsoid")));
  EXPECT_FALSE(
      is_sphere(geometry::ShiftedLevelSet(geometry::make_surface("sphere"), Point(0.01, 0, 0))));
}

TEST(SphereMap, IsTheField) {
  const auto space = make_space(20);
  const SphereMap map(*space, rafts_on(*space));
  double squares = 0;
  for (int k = 0; k < 1000; ++k) {
    const Point x = testing::random_direction(7, static_cast<std::uint64_t>(k));
    squares += std::pow(map.at(x) - rafts_at(x), 2) / 1000;
  }
  EXPECT_LT(std::sqrt(squares), 0.06);
}

TEST(MeshTransfer, TurnsFields) {
  const auto space = make_space(28);
  const Eigen::Matrix3d Q = turn_of(2);
  const MeshTransfer turn(*space, space, Q), back(*space, space, Q.transpose());
  const Vec c = rafts_on(*space);
  Vec expected(space->nodes());
  for (int k = 0; k < space->nodes(); ++k)
    expected[k] = rafts_at(Q.transpose() * space->mesh.position(k).normalized());
  const Vec difference = turn(c) - expected, around = back(turn(c)) - c;
  const double size = std::sqrt(space->inner(c, c));
  EXPECT_LT(std::sqrt(space->inner(difference, difference)), 0.03 * size);
  EXPECT_LT(std::sqrt(space->inner(around, around)), 0.05 * size);
  EXPECT_TRUE(turn.columns(c).col(0).isApprox(turn(c)));
}

}  // namespace
}  // namespace traceraft::assimilation
