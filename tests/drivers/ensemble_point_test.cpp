#include "drivers/ensemble/ensemble_point.hpp"

#include <gtest/gtest.h>

namespace traceraft {
namespace {

// Runs that carry their seed as their only time.
ensemble::PointEnd end_of(const std::vector<std::uint64_t>& seeds) {
  ensemble::PointEnd end;
  end.seeds = seeds;
  for (const std::uint64_t seed : seeds) {
    end.runs.emplace_back();
    end.runs.back().time = {static_cast<double>(seed)};
  }
  return end;
}

TEST(EnsemblePoint, KeepsTheSeedsThatAllPointsHave) {
  std::vector<ensemble::PointEnd> ends{end_of({1, 2, 3, 4}), end_of({2, 3, 4}), end_of({1, 2, 4})};
  ensemble::keep_common_seeds(ends);
  for (const ensemble::PointEnd& end : ends) {
    EXPECT_EQ(end.seeds, (std::vector<std::uint64_t>{2, 4}));
    ASSERT_EQ(end.runs.size(), 2u);
    EXPECT_EQ(end.runs[1].time[0], 4);
  }
}

}  // namespace
}  // namespace traceraft
