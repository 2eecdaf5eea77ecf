#include "kernel/fem/field_transfer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/fem/refinement_rule.hpp"
#include "kernel/mesh/nearest_triangle.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::fem {
namespace {

using testing::make_model;
using testing::random_vector;

constexpr mesh::RefinementLevels kLevels{32, 2};

std::shared_ptr<const SurfaceSpace> space_on(const mesh::RefinementForest& forest,
                                             const geometry::LevelSetPtr& surface) {
  return std::make_shared<const SurfaceSpace>(surface, mesh::build_active_mesh(*surface, forest),
                                              std::make_shared<ThreadTeam>(1),
                                              std::make_shared<SerialCommunicator>());
}

// Fine where z > 0.3.
mesh::RefinementForest fine_cap(const geometry::LevelSet& surface) {
  mesh::RefinementForest forest(surface, kLevels, 0);
  for (int round = 0; round < 3; ++round) {
    const mesh::ActiveMesh mesh = mesh::build_active_mesh(surface, forest);
    std::vector<int> wanted;
    for (const mesh::ActiveTet& tet : mesh.tets)
      wanted.push_back(mesh.position(tet.node[0]).z() > 0.3 ? kLevels.finest_generation() : 0);
    forest = forest.refined(surface, wanted);
  }
  return forest;
}

Vec at_nodes(const SurfaceSpace& space, const std::function<double(const Point&)>& f) {
  Vec values(space.nodes());
  for (int i = 0; i < space.nodes(); ++i) values[i] = f(space.mesh.position(i));
  return values;
}

class FieldTransferTest : public ::testing::Test {
 protected:
  const geometry::LevelSetPtr surface_ = geometry::make_surface("sphere");
  const std::shared_ptr<const SurfaceSpace> fine_ =
      space_on(mesh::RefinementForest(*surface_, kLevels, kLevels.finest_generation()), surface_);
  const std::shared_ptr<const SurfaceSpace> graded_ = space_on(fine_cap(*surface_), surface_);
};

TEST_F(FieldTransferTest, ChangesNothingOnTheSameMesh) {
  const Vec y = random_vector(2 * fine_->nodes(), 3);
  const FieldTransfer same(*fine_, *fine_);
  EXPECT_EQ(same.copied_nodes(), fine_->nodes());
  EXPECT_LT((same.state(y) - y).lpNorm<Eigen::Infinity>(), 1e-14);
}

// Integrals that are taken over from another mesh are those that it would have without.
TEST_F(FieldTransferTest, TakesOverBitForBitWhatMeshesHaveInCommon) {
  const std::vector<int> same = mesh::same_tetrahedra(graded_->mesh, fine_->mesh);
  const auto shared = std::count_if(same.begin(), same.end(), [](int t) { return t >= 0; });
  EXPECT_GT(shared, graded_->mesh.tets.size() / 4);
  EXPECT_LT(shared, graded_->mesh.tets.size());
  const SurfaceSpace next(*fine_, graded_->mesh);
  EXPECT_EQ(next.mass.values, graded_->mass.values);
  EXPECT_EQ(next.stiffness.values, graded_->stiffness.values);
  EXPECT_EQ(next.stabilised_mass.values, graded_->stabilised_mass.values);
  EXPECT_EQ(next.surface.triangle_area, graded_->surface.triangle_area);
  EXPECT_EQ(next.area, graded_->area);
}

TEST_F(FieldTransferTest, KeepsTheValuesOfCommonNodesAndTheMass) {
  const FieldTransfer there(*fine_, *graded_), back(*graded_, *fine_);
  EXPECT_LT(graded_->nodes(), 0.6 * fine_->nodes());
  EXPECT_GT(there.copied_nodes(), 0.9 * graded_->nodes());
  const Vec y = random_vector(2 * fine_->nodes(), 5);
  const Vec moved = there.state(y), returned = back.state(moved);
  EXPECT_NEAR(graded_->integral(moved.head(graded_->nodes())),
              fine_->integral(y.head(fine_->nodes())), 1e-13);
  EXPECT_NEAR(fine_->integral(returned.head(fine_->nodes())),
              graded_->integral(moved.head(graded_->nodes())), 1e-13);
  const Vec mu = y.tail(fine_->nodes()), moved_mu = moved.tail(graded_->nodes());
  for (int i = 0, k = 0; i < graded_->nodes(); ++i) {
    while (k < fine_->nodes() && fine_->mesh.node_id[k] < graded_->mesh.node_id[i]) ++k;
    if (k < fine_->nodes() && fine_->mesh.node_id[k] == graded_->mesh.node_id[i]) {
      ASSERT_EQ(moved_mu[i], mu[k]);
    }
  }
}

// A finer mesh holds every function of a coarser one: new nodes inside old tetrahedra have its
// values exactly, others those of the nearest point.
TEST_F(FieldTransferTest, IsExactForLinearFunctionsButForWhereThereWasNoMesh) {
  const auto plane = [](const Point& x) { return 0.3 + x.x() - 2 * x.y() + 0.5 * x.z(); };
  const Vec there = FieldTransfer(*graded_, *fine_).field(at_nodes(*graded_, plane));
  int off = 0;
  for (int i = 0; i < fine_->nodes(); ++i) {
    const double error = std::fabs(there[i] - plane(fine_->mesh.position(i)));
    if (error > 1e-12) ++off;
    EXPECT_LT(error, 3 * 4 * fine_->h());
  }
  EXPECT_LT(off, 0.3 * fine_->nodes());
}

TEST(NearestTriangleTest, FindsWhatALookAtAllFinds) {
  const geometry::LevelSetPtr surface = geometry::make_surface("ellipsoid");
  const auto space = space_on(fine_cap(*surface), surface);
  const mesh::CutSurface& cut = space->surface;
  const mesh::NearestTriangle tree(cut);
  for (int k = 0; k < 200; ++k) {
    const Point x = (0.2 + 1.3 * uniform_random(4, 4, k)) * testing::random_direction(9, k);
    const auto found = tree.find(x);
    double least = 1e300;
    for (const Point& corner : cut.position) least = std::min(least, (corner - x).norm());
    EXPECT_LE(found.distance, least);
    const auto& triangle = cut.triangles[found.place.triangle];
    Point at = Point::Zero();
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
      at += found.place.at[c] * cut.position[triangle[c]];
      sum += found.place.at[c];
      EXPECT_GE(found.place.at[c], 0);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR((at - x).norm(), found.distance, 1e-12);
    // No triangle comes nearer than the found one: a sample of all.
    for (std::size_t t = 0; t < cut.triangles.size(); t += 7) {
      const auto& [i, j, l] = cut.triangles[t];
      EXPECT_LE(found.distance,
                ((cut.position[i] + cut.position[j] + cut.position[l]) / 3 - x).norm() + 1e-12);
    }
  }
}

TEST(RefinementRuleTest, GradesByTheGradient) {
  const RefinementRule rule{0.08, 0.1, 9};
  EXPECT_EQ(rule.generation(0.2, rule.threshold), 9);
  EXPECT_EQ(rule.generation(0.08, rule.threshold), 9);
  EXPECT_EQ(rule.generation(0.02, rule.threshold), 6);     // a quarter: cells twice as large
  EXPECT_EQ(rule.generation(0.00125, rule.threshold), 0);  // 1/64: eight times
  EXPECT_EQ(rule.generation(0, rule.threshold), 0);
  EXPECT_EQ(rule.generation(0.04, 2 * rule.threshold), 6);
}

TEST(RefinementRuleTest, MeasuresTheGradientAlongTheSurface) {
  const auto space = testing::make_space(32);
  const Vec z = at_nodes(*space, [](const Point& x) { return x.z(); });
  const RefinementRule rule{0.08, 0.1, 9};
  for (const CutElement& element : space->elements) {
    const Point x = space->mesh.position(element.node[0]).normalized();
    EXPECT_NEAR(rule.indicator(element, z), 0.1 * std::sqrt(1 - x.z() * x.z()),
                0.1 * 2 * space->h());
  }
}

TEST(RefinementRuleTest, BoundsWhatCoarseningLeaves) {
  EXPECT_EQ(least_share({3, 3}, {3, 3}), 1);
  EXPECT_EQ(least_share({3, 0, 2, 2}, {3, 3, 3, 3}), (1 + 1.0 / 8 + 0.5 + 0.5) / 4);
}

}  // namespace
}  // namespace traceraft::fem
