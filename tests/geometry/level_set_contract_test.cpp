// The promises of every built-in surface (kernel/geometry/level_set.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/core/random.hpp"
#include "kernel/mesh/cut_surface.hpp"

namespace traceraft::geometry {
namespace {

class LevelSetContract : public ::testing::TestWithParam<std::string> {
 protected:
  LevelSetPtr surface = make_surface(GetParam());
};

Point random_point(int i) {
  const auto u = [&](int axis) {
    return mesh::kBoxHalfWidth * (2 * uniform_random(5, axis, i) - 1);
  };
  return {u(0), u(1), u(2)};
}

Point gradient(const LevelSet& surface, const Point& x, double step) {
  Point g;
  for (int axis = 0; axis < 3; ++axis) {
    const Point e = step * Point::Unit(axis);
    g[axis] = (surface.value(x + e) - surface.value(x - e)) / (2 * step);
  }
  return g;
}

TEST_P(LevelSetContract, IsFiniteInTheBoxAndPositiveOnItsBoundary) {
  for (int i = 0; i < 2000; ++i) {
    Point x = random_point(i);
    EXPECT_TRUE(std::isfinite(surface->value(x)));
    x[i % 3] = i % 2 ? mesh::kBoxHalfWidth : -mesh::kBoxHalfWidth;
    EXPECT_GT(surface->value(x), 0) << x.transpose();
  }
}

TEST_P(LevelSetContract, IsDifferentiableWithAGradientOnTheSurface) {
  int checked = 0;
  for (int i = 0; i < 20000 && checked < 200; ++i) {
    Point x = random_point(i);
    for (int newton = 0; newton < 30; ++newton) {
      const Point g = gradient(*surface, x, 1e-6);
      if (g.squaredNorm() == 0) break;
      x -= std::clamp(surface->value(x) / g.norm(), -0.1, 0.1) * g.normalized();
    }
    if (!(std::fabs(surface->value(x)) < 1e-9) || x.cwiseAbs().maxCoeff() > mesh::kBoxHalfWidth)
      continue;
    ++checked;
    const Point fine = gradient(*surface, x, 1e-5), coarse = gradient(*surface, x, 2e-4);
    EXPECT_GT(fine.norm(), 0.02) << x.transpose();
    EXPECT_LT((fine - coarse).norm(), 1e-3 * (1 + fine.norm())) << x.transpose();
  }
  EXPECT_EQ(checked, 200);
}

TEST_P(LevelSetContract, GivesAClosedSurfaceWithNormalsPointingOut) {
  const mesh::ActiveMesh mesh = mesh::build_active_mesh(*surface, 48);
  const mesh::CutSurface cut = mesh::build_cut_surface(mesh);
  EXPECT_NO_THROW(mesh::require_resolution(mesh, cut));
  EXPECT_EQ(mesh::euler_characteristic(mesh, cut), GetParam() == "torus" ? 0 : 2);
  // Closed and consistently oriented: the area vectors sum to zero, the enclosed volume is
  // positive.
  Point area = Point::Zero();
  double volume = 0;
  for (const auto& [a, b, c] : cut.triangles) {
    const Point x = cut.position[a], y = cut.position[b], z = cut.position[c];
    area += 0.5 * (y - x).cross(z - x);
    volume += x.dot(y.cross(z)) / 6;
  }
  EXPECT_LT(area.norm(), 1e-12);
  EXPECT_GT(volume, 0.3);
}

INSTANTIATE_TEST_SUITE_P(All, LevelSetContract, ::testing::ValuesIn(surfaces().names()),
                         [](const auto& info) { return info.param; });

TEST(Surfaces, HaveTheSizesTheyAreAskedFor) {
  EXPECT_DOUBLE_EQ(make_surface("sphere")->value({0, 0, 1.25}), 0.25);
  EXPECT_DOUBLE_EQ(make_surface("torus:major=0.9,minor=0.3")->value({1.3, 0, 0}), 0.1);
  EXPECT_NEAR(make_surface("ellipsoid:a=1.5")->value({1.5, 0, 0}), 0, 1e-15);
  const LevelSetPtr cell = make_surface("biconcave:middle=0.25,rim=0.53");
  EXPECT_NEAR(cell->value({1, 0, 0}), 0, 1e-14);
  EXPECT_NEAR(cell->value({0, 0, 0.125}), 0, 1e-14);
  double thickest = 0;  // largest z with φ = 0
  for (double rho = 0; rho < 1; rho += 1e-4) {
    double low = 0, high = 0.5;
    if (cell->value({rho, 0, 0}) > 0) continue;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (cell->value({rho, 0, middle}) < 0 ? low : high) = middle;
    }
    thickest = std::max(thickest, low);
  }
  EXPECT_NEAR(thickest, 0.265, 1e-4);
}

TEST(Surfaces, RefuseImpossibleShapes) {
  EXPECT_THROW(make_surface("torus:major=0.3,minor=0.5"), InputError);
  EXPECT_THROW(make_surface("biconcave:middle=0.6,rim=0.5"), InputError);
  EXPECT_THROW(make_surface("cube"), InputError);
}

}  // namespace
}  // namespace traceraft::geometry
