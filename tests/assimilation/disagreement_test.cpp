// The disagreements that are significant.
#include "verification/assimilation/filter/disagreement.hpp"

#include <gtest/gtest.h>

namespace traceraft::assimilation {
namespace {

std::vector<Disagreement> with(const std::vector<double>& p) {
  std::vector<Disagreement> all;
  for (const double value : p) all.push_back({0, 0, "", Point::Zero(), 0, value});
  return all;
}

// The share of false ones is controlled, not that there is any: what is beyond level/n may count if
// enough is as small (Benjamini and Hochberg 1995).
TEST(Disagreements, AreSignificantTogether) {
  EXPECT_EQ(significant(with({0.001, 0.019, 0.029, 0.6}), 0.04), 3u);
  EXPECT_EQ(significant(with({0.011, 0.019, 0.031, 0.6}), 0.04), 2u);
  EXPECT_EQ(significant(with({0.011, 0.021, 0.031, 0.6}), 0.04), 0u);
  EXPECT_EQ(significant(with({}), 0.04), 0u);
}

}  // namespace
}  // namespace traceraft::assimilation
