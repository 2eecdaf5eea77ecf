#include "drivers/run/memory_need.hpp"

#include <gtest/gtest.h>

#include "kernel/core/error.hpp"
#include "kernel/mesh/active_mesh.hpp"

namespace traceraft {
namespace {

TEST(MemoryNeed, GrowsWithTheSurfaceAndTheSquareOfTheCells) {
  const geometry::LevelSetPtr sphere = geometry::make_surface("sphere");
  EXPECT_EQ(run::least_memory(*sphere, 256, 1), 0);  // fits anywhere
  const double fine = run::least_memory(*sphere, 2048, 1);
  EXPECT_NEAR(run::least_memory(*sphere, 4096, 1) / fine, 4, 1e-9);
  EXPECT_NEAR(run::least_memory(*sphere, 2048, 4) / fine, 0.25, 1e-9);
  // 11.2 million nodes, of 2 to 5 kB each.
  EXPECT_GT(fine, 22e9);
  EXPECT_LT(fine, 56e9);
  EXPECT_EQ(run::nodes_of_fine_mesh(*sphere, 256), 0);
  const auto nodes = static_cast<double>(mesh::build_active_mesh(*sphere, 512).nodes());
  EXPECT_NEAR(run::nodes_of_fine_mesh(*sphere, 512) / nodes, 1, 0.02);
  EXPECT_LT(run::least_memory(*geometry::make_surface("ellipsoid:a=0.3,b=0.3,c=0.3"), 2048, 1),
            0.2 * fine);
}

TEST(MemoryNeed, IsComparedWithWhatThereIs) {
  EXPECT_EQ(run::memory_complaint(4096, 1e11, 2e11), "");
  EXPECT_EQ(
      run::memory_complaint(4096, 1.12e11, 2.5e10),
      "4096 per edge need at least 112 GB of memory on each rank, and this machine has 25 GB; "
      "choose 1935 at most, or ranks on several machines");
  // Nothing is known of a surface that the coarse mesh does not find.
  EXPECT_EQ(
      run::least_memory(geometry::FunctionLevelSet([](const Point&) { return 1.0; }), 4096, 1), 0);
}

}  // namespace
}  // namespace traceraft
