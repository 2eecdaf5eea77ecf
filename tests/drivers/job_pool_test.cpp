#include "drivers/jobs/job_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace traceraft {
namespace {

TEST(JobPool, DoesEveryJobOnce) {
  std::vector<std::atomic<int>> times(50);
  jobs::JobPool pool(times.size(), [&](std::size_t k) {
    ++times[k];
    return true;
  });
  pool.start(4);
  EXPECT_TRUE(pool.finish());
  EXPECT_FALSE(pool.busy());
  EXPECT_EQ(pool.ended(), times.size());
  EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](const auto& n) { return n == 1; }));
}

TEST(JobPool, StopsWhereAJobWantsIt) {
  std::atomic<int> begun{0};
  jobs::JobPool pool(50, [&](std::size_t k) {
    ++begun;
    return k != 3;
  });
  pool.start(1);
  EXPECT_FALSE(pool.finish());
  EXPECT_EQ(begun, 4);
}

TEST(JobPool, PassesOnWhatAJobThrows) {
  jobs::JobPool pool(50, [](std::size_t k) -> bool {
    if (k == 2) throw std::runtime_error("no");
    return true;
  });
  pool.start(2);
  EXPECT_THROW(pool.finish(), std::runtime_error);
}

TEST(JobPool, WithNothingToDoIsDone) {
  jobs::JobPool pool(0, [](std::size_t) { return false; });
  pool.start(2);
  EXPECT_TRUE(pool.finish());
}

}  // namespace
}  // namespace traceraft
