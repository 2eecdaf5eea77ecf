#include "kernel/core/thread_team.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <thread>

namespace traceraft {
namespace {

class ThreadTeamTest : public ::testing::TestWithParam<int> {};

TEST_P(ThreadTeamTest, RunsEveryPartOnceAndCoversEveryRange) {
  const ThreadTeam team(GetParam());
  for (int round = 0; round < 200; ++round) {
    std::vector<int> hits(1000, 0);
    team.for_range(hits.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++hits[i];
    });
    ASSERT_EQ(std::accumulate(hits.begin(), hits.end(), 0), 1000);
    ASSERT_EQ(*std::min_element(hits.begin(), hits.end()), 1);
  }
}

// Longer than a thread looks for work, or for the end of it, before it sleeps.
TEST_P(ThreadTeamTest, WakesUp) {
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(2)); };
  const ThreadTeam team(GetParam());
  std::atomic<int> count{0};
  for (int round = 0; round < 20; ++round) {
    team.run([&](int part) {
      if (part == GetParam() - 1) pause();
      ++count;
    });
    pause();
  }
  EXPECT_EQ(count, 20 * GetParam());
}

TEST_P(ThreadTeamTest, RunsNestedWorkInTheSameThread) {
  const ThreadTeam team(GetParam());
  std::atomic<int> count{0};
  team.run([&](int) { team.run([&](int) { ++count; }); });
  EXPECT_EQ(count, GetParam() * GetParam());
}

TEST_P(ThreadTeamTest, HandsAnExceptionToTheCaller) {
  const ThreadTeam team(GetParam());
  const int last = GetParam() - 1;
  EXPECT_THROW(team.run([&](int part) {
    if (part == last) throw std::runtime_error("no");
  }),
               std::runtime_error);
  int ran = 0;
  team.run([&](int part) { ran += part == 0; });  // the team still works
  EXPECT_EQ(ran, 1);
}

INSTANTIATE_TEST_SUITE_P(Sizes, ThreadTeamTest, ::testing::Values(1, 2, 5));

}  // namespace
}  // namespace traceraft
