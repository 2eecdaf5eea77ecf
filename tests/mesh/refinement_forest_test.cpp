#include "kernel/mesh/refinement_forest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "kernel/core/random.hpp"
#include "kernel/mesh/cut_surface.hpp"

namespace traceraft::mesh {
namespace {

// Generations that are drawn leaf by leaf, mostly small ones.
std::vector<int> random_generations(const RefinementForest& forest, std::uint64_t seed) {
  std::vector<int> wanted;
  for (std::size_t t = 0; t < forest.leaf_cells().size(); ++t) {
    const double u = uniform_random(seed, 5, t);
    wanted.push_back(u < 0.02 ? forest.levels().finest_generation() : static_cast<int>(3 * u));
  }
  return wanted;
}

std::vector<std::int64_t> nodes_of(const geometry::LevelSet& surface,
                                   const RefinementForest& forest) {
  return build_active_mesh(surface, forest).node_id;
}

// Sides of triangles that do not belong to exactly two of them.
int open_sides(const CutSurface& surface) {
  std::map<std::pair<int, int>, int> count;
  for (const auto& triangle : surface.triangles)
    for (int k = 0; k < 3; ++k) ++count[std::minmax(triangle[k], triangle[(k + 1) % 3])];
  return static_cast<int>(
      std::count_if(count.begin(), count.end(), [](const auto& side) { return side.second != 2; }));
}

// Nodes of the mesh in the middle of one of its edges.
int hanging_nodes(const ActiveMesh& mesh) {
  const std::set<std::int64_t> ids(mesh.node_id.begin(), mesh.node_id.end());
  int hanging = 0;
  for (const auto& [low, high] : mesh.edges) {
    const Lattice a = mesh.cube.vertex(mesh.node_id[low]), b = mesh.cube.vertex(mesh.node_id[high]);
    if ((a[0] + b[0]) % 2 || (a[1] + b[1]) % 2 || (a[2] + b[2]) % 2) continue;
    hanging += static_cast<int>(
        ids.count(mesh.cube.vertex_id({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2})));
  }
  return hanging;
}

double area_of(const CutSurface& surface) {
  return std::accumulate(surface.triangle_area.begin(), surface.triangle_area.end(), 0.0);
}

TEST(RefinementForest, AnyWishesGiveAClosedSurfaceWithoutHangingNodes) {
  for (const std::string& name : geometry::surfaces().names()) {
    const geometry::LevelSetPtr surface = geometry::make_surface(name);
    const std::int64_t characteristic = name == "torus" ? 0 : 2;
    RefinementForest forest(*surface, {64, 2}, 0);
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const std::vector<int> wanted = random_generations(forest, seed);
      const RefinementForest next = forest.refined(*surface, wanted);
      const ActiveMesh mesh = build_active_mesh(*surface, next);
      const CutSurface cut = build_cut_surface(mesh);
      EXPECT_EQ(open_sides(cut), 0) << name << ' ' << seed;
      EXPECT_EQ(euler_characteristic(mesh, cut), characteristic) << name << ' ' << seed;
      EXPECT_EQ(hanging_nodes(mesh), 0) << name << ' ' << seed;
      forest = next;
    }
  }
}

TEST(RefinementForest, GivesEachPlaceAtLeastWhatIsWantedThere) {
  const geometry::LevelSetPtr surface = geometry::make_surface("ellipsoid");
  const RefinementForest coarse(*surface, {64, 3}, 0);
  const auto in_cap = [](const Point& x) { return x.z() > 0.5; };
  RefinementForest forest = coarse;
  for (int round = 0; round < 3; ++round) {
    const ActiveMesh mesh = build_active_mesh(*surface, forest);
    std::vector<int> wanted;
    for (const ActiveTet& tet : mesh.tets)
      wanted.push_back(std::any_of(tet.node.begin(), tet.node.end(),
                                   [&](int node) { return in_cap(mesh.position(node)); })
                           ? 9
                           : 0);
    forest = forest.refined(*surface, wanted);
  }
  const ActiveMesh mesh = build_active_mesh(*surface, forest);
  const std::vector<int> generation = forest.leaf_generations();
  int coarsest = 9;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    coarsest = std::min(coarsest, generation[t]);
    EXPECT_NEAR(mesh.shape(mesh.tets[t]).size, std::exp2((9 - generation[t]) / 3.0), 1e-12);
    for (const int node : mesh.tets[t].node)
      if (in_cap(mesh.position(node))) {
        EXPECT_EQ(generation[t], 9);
      }
  }
  EXPECT_EQ(coarsest, 0);
}

TEST(RefinementForest, KeepsWhatIsWantedAsItIs) {
  const geometry::LevelSetPtr surface = geometry::make_surface("biconcave");
  const RefinementForest coarse(*surface, {64, 2}, 1);
  const RefinementForest forest = coarse.refined(*surface, random_generations(coarse, 4));
  EXPECT_NE(nodes_of(*surface, forest), nodes_of(*surface, coarse));
  EXPECT_EQ(nodes_of(*surface, forest.refined(*surface, forest.leaf_generations())),
            nodes_of(*surface, forest));
  const std::vector<int> coarsest(forest.leaf_cells().size(), 1);
  EXPECT_EQ(nodes_of(*surface, forest.refined(*surface, coarsest)), nodes_of(*surface, coarse));
}

TEST(RefinementForest, IsItsBits) {
  const geometry::LevelSetPtr surface = geometry::make_surface("dziuk");
  const RefinementForest coarse(*surface, {64, 2}, 0);
  const RefinementForest forest = coarse.refined(*surface, random_generations(coarse, 9));
  const RefinementForest again(*surface, forest.levels(), forest.bits());
  EXPECT_EQ(again.bits(), forest.bits());
  const ActiveMesh a = build_active_mesh(*surface, forest), b = build_active_mesh(*surface, again);
  EXPECT_EQ(a.node_id, b.node_id);
  EXPECT_EQ(a.tets.size(), b.tets.size());
  std::vector<bool> bits = forest.bits();
  bits.pop_back();
  EXPECT_THROW(RefinementForest(*surface, forest.levels(), bits), IoError);
  bits.assign(bits.size() + 1, true);
  EXPECT_THROW(RefinementForest(*surface, forest.levels(), bits), IoError);
}

// It is another mesh of the same lattice: its diagonals alternate.
TEST(RefinementForest, IsLikeAUniformMeshWhereAllIsFine) {
  for (const std::string& name : geometry::surfaces().names()) {
    const geometry::LevelSetPtr surface = geometry::make_surface(name);
    const ActiveMesh uniform = build_active_mesh(*surface, 64),
                     mesh = build_active_mesh(*surface, RefinementForest(*surface, {64, 3}, 9));
    EXPECT_NEAR(mesh.nodes(), uniform.nodes(), 0.02 * uniform.nodes()) << name;
    EXPECT_NEAR(area_of(build_cut_surface(mesh)) / area_of(build_cut_surface(uniform)), 1, 1e-3)
        << name;
    for (const ActiveTet& tet : mesh.tets) ASSERT_EQ(mesh.shape(tet).six_volumes, 1);
  }
}

TEST(RefinementForest, FindsPartsThatTheCoarsestMeshDoesNotSee) {
  const geometry::FunctionLevelSet two([](const Point& x) {
    return std::min((x - Point(0.5, 0, 0)).norm() - 0.6,
                    (x - Point(-0.93, 0.1, 0.1)).norm() - 0.12);
  });
  const ActiveMesh mesh = build_active_mesh(two, RefinementForest(two, {64, 3}, 9));
  EXPECT_EQ(euler_characteristic(mesh, build_cut_surface(mesh)), 4);
}

TEST(RefinementForest, NamesCellsThatCanBeHalved) {
  const geometry::LevelSetPtr surface = geometry::make_surface("sphere");
  const auto complaint = [&](std::int64_t cells, int levels) -> std::string {
    try {
      RefinementForest(*surface, {cells, levels}, 0);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(complaint(100, 3), "cells: 100 cannot be halved 3 times to at least 4; nearest: 104");
  EXPECT_EQ(complaint(16, 3), "cells: 16 cannot be halved 3 times to at least 4; nearest: 32");
  EXPECT_EQ(complaint(64, 0), "mesh-levels: 0 is out of range [1, 8]");
  EXPECT_EQ(complaint(64, 9), "mesh-levels: 9 is out of range [1, 8]");
}

TEST(TetShape, HasTheGradientsOfItsCoordinates) {
  const std::array<Lattice, 4> at = {{{0, 0, 0}, {2, 0, 0}, {1, 1, 1}, {2, 2, 0}}};
  const TetShape shape = tet_shape(at);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      double difference = 0;  // λ_i at vertex j less that at vertex 0
      for (int axis = 0; axis < 3; ++axis)
        difference += shape.gradients(i, axis) *
                      static_cast<double>(at[static_cast<std::size_t>(j)][axis] - at[0][axis]);
      EXPECT_EQ(difference, (i == j) - (i == 0)) << i << ' ' << j;
    }
  EXPECT_EQ(shape.six_volumes, 4);
  EXPECT_NEAR(shape.size, std::cbrt(4.0), 1e-15);
  EXPECT_TRUE(shape.left_handed);
}

}  // namespace
}  // namespace traceraft::mesh
