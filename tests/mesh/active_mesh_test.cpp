#include "kernel/mesh/active_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "kernel/core/random.hpp"
#include "kernel/fem/cut_elements.hpp"
#include "kernel/mesh/cut_cells.hpp"
#include "kernel/mesh/cut_surface.hpp"

namespace traceraft::mesh {
namespace {

constexpr double kSphereArea = 4 * M_PI;

// Counts how often the level set is asked for.
class Counting final : public geometry::LevelSet {
 public:
  explicit Counting(geometry::LevelSetPtr base) : base_(std::move(base)) {}
  double value(const Point& x) const override {
    ++calls;
    return base_->value(x);
  }
  mutable long calls = 0;

 private:
  geometry::LevelSetPtr base_;
};

double area_of(const ActiveMesh& mesh) {
  const CutSurface surface = build_cut_surface(mesh);
  return std::accumulate(surface.triangle_area.begin(), surface.triangle_area.end(), 0.0);
}

std::string complaint(const geometry::LevelSet& surface, int cells) {
  try {
    const ActiveMesh mesh = build_active_mesh(surface, cells);
    require_resolution(mesh, build_cut_surface(mesh));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(ActiveMesh, IsTheMeshOfTheReferenceResults) {
  const ActiveMesh mesh = build_active_mesh(*geometry::make_surface("sphere"), 128);
  EXPECT_EQ(mesh.tets.size(), 127080u);
  EXPECT_EQ(mesh.nodes(), 43864);
  EXPECT_NEAR(area_of(mesh) / kSphereArea - 1, -1.7e-4, 1e-5);
}

TEST(ActiveMesh, FindsExactlyTheCellsThatASearchOfTheWholeCubeFinds) {
  for (const std::string& name : geometry::surfaces().names()) {
    const geometry::LevelSetPtr surface = geometry::make_surface(name);
    const CubeMesh mesh{32};
    std::vector<std::int64_t> expected;
    for (std::int64_t id = 0; id < 32 * 32 * 32; ++id) {
      int negative = 0;
      for (int corner = 0; corner < 8; ++corner)
        negative += surface->value(mesh.position(corner_of(mesh.cell(id), corner))) < 0;
      if (negative > 0 && negative < 8) expected.push_back(id);
    }
    EXPECT_EQ(find_cut_cells(*surface, mesh), expected) << name;
  }
}

TEST(ActiveMesh, FindsSeveralSurfaces) {
  const geometry::FunctionLevelSet two([](const Point& x) {
    return std::min((x - Point(0.7, 0, 0)).norm() - 0.5, (x + Point(0.7, 0, 0)).norm() - 0.3);
  });
  const ActiveMesh mesh = build_active_mesh(two, 96);
  EXPECT_NEAR(area_of(mesh), kSphereArea * (0.25 + 0.09), 0.01);
  EXPECT_EQ(euler_characteristic(mesh, build_cut_surface(mesh)), 4);
}

TEST(ActiveMesh, CostsGrowLikeTheSurfaceNotTheCube) {
  std::vector<double> calls;
  for (const int cells : {128, 256}) {
    const Counting surface(geometry::make_surface("sphere"));
    find_cut_cells(surface, {cells});
    calls.push_back(static_cast<double>(surface.calls - 65 * 65 * 65));
  }
  EXPECT_LT(calls[1] / calls[0], 4.3);
}

TEST(ActiveMesh, SharesEdgesAndKeepsGlobalOrder) {
  const ActiveMesh mesh = build_active_mesh(*geometry::make_surface("dziuk"), 24);
  EXPECT_TRUE(std::is_sorted(mesh.node_id.begin(), mesh.node_id.end()));
  std::set<std::pair<int, int>> pairs;
  for (const ActiveTet& tet : mesh.tets)
    for (int e = 0; e < 6; ++e) {
      const auto [low, high] = mesh.edges[tet.edge[e]];
      EXPECT_EQ(low, tet.node[kTetEdges[e][0]]);
      EXPECT_EQ(high, tet.node[kTetEdges[e][1]]);
      pairs.insert({low, high});
    }
  EXPECT_EQ(pairs.size(), mesh.edges.size());
}

// The surface through vertices, edges and faces: planes of lattice points and a sphere that passes
// through mesh nodes (n = 90: h = 1/27).
TEST(CutGeometry, SurvivesASurfaceThroughVertices) {
  for (const int cells : {60, 90, 180}) {
    const ActiveMesh mesh = build_active_mesh(*geometry::make_surface("sphere"), cells);
    EXPECT_NEAR(area_of(mesh) / kSphereArea - 1, -1.7e-4 * std::pow(128.0 / cells, 2), 4e-5)
        << cells;
    EXPECT_EQ(euler_characteristic(mesh, build_cut_surface(mesh)), 2) << cells;
  }
  // A cube whose faces are faces of cells: nothing is lost or counted twice against a cube that is
  // smaller by 1e-7 and in general position.
  const auto cube = [](double half_width) {
    return build_active_mesh(geometry::FunctionLevelSet([=](const Point& x) {
                               return x.cwiseAbs().maxCoeff() - half_width;
                             }),
                             20);
  };
  EXPECT_NEAR(area_of(cube(1)) / area_of(cube(1 - 1e-7)), 1, 1e-6);
  EXPECT_EQ(euler_characteristic(cube(1), build_cut_surface(cube(1))), 2);
}

TEST(CutGeometry, DoesNotDependOnWhereTheMeshLies) {
  const geometry::LevelSetPtr sphere = geometry::make_surface("sphere");
  for (int i = 0; i < 100; ++i) {
    const Point offset = 0.2 * Point(uniform_random(1, 0, i) - 0.5, uniform_random(1, 1, i) - 0.5,
                                     uniform_random(1, 2, i) - 0.5);
    const ActiveMesh mesh = build_active_mesh(geometry::ShiftedLevelSet(sphere, offset), 24);
    EXPECT_NEAR(area_of(mesh) / kSphereArea - 1, -4.8e-3, 5e-4) << offset.transpose();
    EXPECT_EQ(euler_characteristic(mesh, build_cut_surface(mesh)), 2);
  }
}

TEST(CutGeometry, AgreesBetweenElementsAndSurface) {
  const ActiveMesh mesh = build_active_mesh(*geometry::make_surface("torus"), 32);
  const CutSurface surface = build_cut_surface(mesh);
  double area = 0;
  for (std::size_t k = 0; k < surface.triangles.size(); ++k) {
    const auto [a, b, c] = surface.triangles[k];
    const Point x = surface.position[a];
    const Point vector = 0.5 * (surface.position[b] - x).cross(surface.position[c] - x);
    area += vector.norm();
    // Counter-clockwise seen from outside.
    EXPECT_GE(vector.dot(cut_normal(mesh, mesh.tets[surface.triangle_tet[k]])), -1e-18);
  }
  EXPECT_NEAR(area, area_of(mesh), 1e-12);
}

TEST(CutGeometry, RefusesWhatItCannotRepresent) {
  const geometry::LevelSetPtr sphere = geometry::make_surface("sphere");
  EXPECT_NE(complaint(*sphere, 4).find("too coarse"), std::string::npos);
  EXPECT_EQ(complaint(*sphere, 8), "");
  EXPECT_NE(complaint(*geometry::make_surface("biconcave"), 8), "");
  EXPECT_NE(complaint(geometry::ShiftedLevelSet(sphere, {1, 0, 0}), 32).find("boundary of the box"),
            std::string::npos);
  EXPECT_NE(complaint(geometry::ShiftedLevelSet(sphere, {9, 0, 0}), 32).find("no surface"),
            std::string::npos);
  EXPECT_NE(complaint(geometry::FunctionLevelSet([](const Point& x) { return std::log(x[0]); }), 16)
                .find("not finite"),
            std::string::npos);
}

}  // namespace
}  // namespace traceraft::mesh
