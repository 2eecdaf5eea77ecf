#include "kernel/mesh/lifted_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace traceraft::mesh {
namespace {

struct Lift {
  ActiveMesh mesh;
  CutSurface surface;
  std::vector<LiftedTriangle> triangles;

  Lift(const geometry::LevelSet& level_set, int cells)
      : mesh(build_active_mesh(level_set, cells)),
        surface(build_cut_surface(mesh)),
        triangles(lifted_triangles(level_set, mesh, surface, ThreadTeam(1))) {}
  double area() const {
    double sum = 0;
    for (const LiftedTriangle& triangle : triangles) sum += triangle.area;
    return sum;
  }
  Point corner(std::size_t triangle, int k) const {
    return surface.position[surface.triangles[triangle][k]];
  }
};

// x ↦ x/|x| has the derivative (1 − n nᵀ)/|x|, n = x/|x|.
TEST(LiftedSurface, HasTheMetricOfTheUnitSphere) {
  const Lift lift(*geometry::make_surface("sphere"), 16);
  for (std::size_t t = 0; t < lift.triangles.size(); ++t) {
    const Point normal = cut_normal(lift.mesh, lift.mesh.tets[lift.surface.triangle_tet[t]]);
    double stretch = 0;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const Point x = 0.5 * (lift.corner(t, k) + lift.corner(t, (k + 1) % 3)), n = x.normalized();
      // The inverse of the form within the plane, and 0 along its normal.
      const Eigen::Matrix3d plane = Eigen::Matrix3d::Identity() - normal * normal.transpose();
      const Eigen::Matrix3d form =
          plane * (Eigen::Matrix3d::Identity() - n * n.transpose()) * plane / x.squaredNorm();
      const Eigen::Matrix3d inverse =
          (form + normal * normal.transpose()).inverse() - normal * normal.transpose();
      const double area = normal.dot(n) / x.squaredNorm();
      stretch += area / 3;
      sum += area / 3 * inverse;
    }
    EXPECT_NEAR(lift.triangles[t].area / lift.surface.triangle_area[t], stretch, 1e-5);
    EXPECT_LT((lift.triangles[t].inverse_metric - sum / stretch).cwiseAbs().maxCoeff(), 1e-5);
  }
}

TEST(LiftedSurface, LiesOnASurfaceWhoseLevelSetIsNoDistance) {
  const geometry::LevelSetPtr ellipsoid = geometry::make_surface("ellipsoid");
  const Lift lift(*ellipsoid, 32);
  const double h = lift.mesh.cube.h();
  double before = 0, after = 0;
  for (std::size_t t = 0; t < lift.triangles.size(); ++t) {
    const Point middle = (lift.corner(t, 0) + lift.corner(t, 1) + lift.corner(t, 2)) / 3;
    before = std::max(before, std::fabs(ellipsoid->value(middle)));
    after = std::max(after, std::fabs(ellipsoid->value(lifted(*ellipsoid, middle, h))));
  }
  EXPECT_GT(before, 1e-4);
  EXPECT_LT(after, 1e-7);  // of the order h^6
}

// The flat triangles' areas err by 1 % on 16 cells, in order 2.
TEST(LiftedSurface, AreasConvergeInOrderFour) {
  for (const auto& [name, exact] :
       {std::pair("sphere", 4 * M_PI), std::pair("torus", 4 * M_PI * M_PI * 0.4)}) {
    const geometry::LevelSetPtr surface = geometry::make_surface(name);
    double error[2];
    for (int level = 0; level < 2; ++level)
      error[level] = std::fabs(Lift(*surface, 24 << level).area() / exact - 1);
    EXPECT_LT(error[1], 2e-5) << name;
    EXPECT_GT(error[0] / error[1], 10) << name;
  }
}

// Where the surface has an edge there is no lift that is nearly flat.
TEST(LiftedSurface, StaysFlatAtAnEdge) {
  const geometry::FunctionLevelSet cube(
      [](const Point& x) { return x.cwiseAbs().maxCoeff() - 0.7; });
  const Lift lift(cube, 20);
  EXPECT_NEAR(lift.area() / (6 * 1.4 * 1.4), 1, 0.03);
  for (const LiftedTriangle& triangle : lift.triangles) {
    EXPECT_TRUE(triangle.inverse_metric.allFinite());
    EXPECT_LT(triangle.inverse_metric.cwiseAbs().maxCoeff(), 4);
  }
}

TEST(LiftedSurface, StaysFlatWhereTheLevelSetIsNotFinite) {
  const geometry::FunctionLevelSet shell([](const Point& x) {
    const double distance = x.norm() - 1;
    return std::fabs(distance) < 1e-4 ? std::nan("") : distance;
  });
  const Lift lift(shell, 16);
  for (std::size_t t = 0; t < lift.triangles.size(); ++t)
    EXPECT_EQ(lift.triangles[t].area, lift.surface.triangle_area[t]);
}

}  // namespace
}  // namespace traceraft::mesh
