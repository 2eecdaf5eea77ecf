#include "kernel/mesh/partition.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <mutex>
#include <set>

#include "kernel/core/error.hpp"
#include "kernel/mesh/active_mesh.hpp"
#include "tests/support/rank_contract.hpp"
#include "tests/support/thread_ranks.hpp"

namespace traceraft::mesh {
namespace {

using testing::run_on_ranks;

// A tetrahedron as the ids of its vertices.
using Tet = std::array<std::int64_t, 4>;

std::vector<Tet> tets_of(const ActiveMesh& mesh, bool owned_only) {
  std::vector<Tet> tets;
  for (const ActiveTet& tet : mesh.tets) {
    if (owned_only && !mesh.owns(tet)) continue;
    Tet ids{};
    for (std::size_t i = 0; i < 4; ++i) ids[i] = mesh.node_id[tet.node[i]];
    tets.push_back(ids);
  }
  return tets;
}

// Two balls joined by a tube so thin that the lattice where walks begin does not see it.
double dumbbell(const Point& x) {
  const double balls = std::min((x - Point(0.9, 0, 0)).norm(), (x + Point(0.9, 0, 0)).norm()) - 0.5;
  const Point axis(x[0], x[1] - 0.026, x[2] - 0.026);  // between the points of the lattice
  const double tube = std::hypot(axis[1], axis[2]) - 0.02;
  return std::fabs(x[0]) < 0.9 ? std::min(balls, tube) : balls;
}

TEST(ThreadRanks, AreACommunicator) {
  for (const int size : {1, 2, 3, 5})
    run_on_ranks(size, [](const auto& ranks) { testing::check_communicator(*ranks); });
}

TEST(Partition, FollowsAHilbertCurve) {
  constexpr int kBits = 3, kSize = 1 << kBits;
  std::map<std::uint64_t, Lattice> at;
  for (std::int64_t k = 0; k < kSize; ++k)
    for (std::int64_t j = 0; j < kSize; ++j)
      for (std::int64_t i = 0; i < kSize; ++i) at[hilbert_position({i, j, k}, kBits)] = {i, j, k};
  ASSERT_EQ(at.size(), static_cast<std::size_t>(kSize * kSize * kSize));
  EXPECT_EQ(at.rbegin()->first, at.size() - 1);
  for (std::uint64_t position = 1; position < at.size(); ++position) {
    std::int64_t distance = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      distance += std::llabs(at[position][axis] - at[position - 1][axis]);
    EXPECT_EQ(distance, 1) << position;
  }
}

TEST(Partition, SharesTheMeshEvenlyAndCompletely) {
  for (const std::string surface : {"sphere", "torus", "biconcave"})
    for (const int ranks : {2, 3, 7}) {
      const ActiveMesh whole = build_active_mesh(*geometry::make_surface(surface), 64);
      const std::vector<Tet> expected = tets_of(whole, false);
      std::multiset<Tet> owned;
      std::set<std::int64_t> nodes;
      std::size_t most = 0;
      std::mutex mutex;
      run_on_ranks(ranks, [&](const auto& communicator) {
        const ActiveMesh part =
            build_active_mesh(*geometry::make_surface(surface), 64, *communicator);
        const std::vector<Tet> mine = tets_of(part, true);
        const std::lock_guard lock(mutex);
        owned.insert(mine.begin(), mine.end());
        nodes.insert(part.node_id.begin(), part.node_id.begin() + part.owned_nodes);
        most = std::max(most, mine.size());
      });
      EXPECT_EQ(owned, std::multiset<Tet>(expected.begin(), expected.end()))
          << surface << " on " << ranks;
      EXPECT_EQ(nodes.size(), whole.node_id.size());
      EXPECT_LT(static_cast<double>(most), 1.1 * static_cast<double>(expected.size()) / ranks)
          << surface << " on " << ranks;
    }
}

// Ghosts are where the plan says, and in global order everything that adds to an owned row is here.
TEST(Partition, RefusesMoreRanksThanItHasWorkFor) {
  EXPECT_NO_THROW(Partition(*geometry::make_surface("sphere"), {8}, 7));
  try {
    Partition(*geometry::make_surface("sphere"), {8}, 5000);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("5000 ranks are too many"), std::string::npos);
  }
}

TEST(Partition, EveryRankHasAllThatTouchesItsNodes) {
  const ActiveMesh whole = build_active_mesh(*geometry::make_surface("ellipsoid"), 48);
  std::map<std::int64_t, std::vector<Tet>> at_node;
  for (const Tet& tet : tets_of(whole, false))
    for (const std::int64_t id : tet) at_node[id].push_back(tet);
  run_on_ranks(4, [&](const auto& communicator) {
    const ActiveMesh part =
        build_active_mesh(*geometry::make_surface("ellipsoid"), 48, *communicator);
    std::map<std::int64_t, std::vector<Tet>> mine;
    for (const Tet& tet : tets_of(part, false))
      for (const std::int64_t id : tet) mine[id].push_back(tet);
    for (int i = 0; i < part.owned_nodes; ++i)
      EXPECT_EQ(mine[part.node_id[i]], at_node[part.node_id[i]]);
    Vec ids(part.nodes());
    ids.setConstant(-1);
    for (int i = 0; i < part.owned_nodes; ++i) ids[i] = static_cast<double>(part.node_id[i]);
    communicator->update_ghosts(part.halo, ids);
    for (int i = 0; i < part.nodes(); ++i)
      EXPECT_EQ(ids[i], static_cast<double>(part.node_id[i])) << i;
  });
}

TEST(Partition, WalksGoOnWhereAnotherRankBegins) {
  const geometry::FunctionLevelSet surface(dumbbell);
  const std::size_t expected = build_active_mesh(surface, 256).tets.size();
  for (const int ranks : {2, 5}) {
    std::size_t found = 0;
    std::mutex mutex;
    run_on_ranks(ranks, [&](const auto& communicator) {
      const std::size_t mine = tets_of(build_active_mesh(surface, 256, *communicator), true).size();
      const std::lock_guard lock(mutex);
      found += mine;
    });
    EXPECT_EQ(found, expected) << ranks;
  }
}

TEST(Partition, RefusesMoreRanksThanTheMeshHasRoomFor) {
  EXPECT_THROW(run_on_ranks(40,
                            [](const auto& communicator) {
                              (void)build_active_mesh(*geometry::make_surface("sphere"), 4,
                                                      *communicator);
                            }),
               InputError);
}

}  // namespace
}  // namespace traceraft::mesh
