// The quick form of every verification study holds.
#include <gtest/gtest.h>

#include "verification/studies.hpp"

namespace traceraft {
namespace {

class StudyTest : public ::testing::TestWithParam<std::string> {};

TEST_P(StudyTest, Holds) {
  const StudyReport report = studies().find(GetParam()).run({true});
  if (!report.skipped.empty()) GTEST_SKIP() << report.skipped;
  EXPECT_FALSE(report.claims.empty());
  for (const Claim& claim : report.claims)
    EXPECT_TRUE(claim.holds()) << claim.what << ": " << claim.measured << " is not in ["
                               << claim.low << ", " << claim.high << "]";
}

std::vector<std::string> untimed_studies() {
  std::vector<std::string> names;
  for (const StudyEntry& study : studies())
    if (!study.timed) names.push_back(study.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Quick, StudyTest, ::testing::ValuesIn(untimed_studies()),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& ch : name)
                             if (ch == '-') ch = '_';
                           return name;
                         });

// Timed studies run; what they measure is not judged here.
TEST(TimedStudies, Run) {
  for (const StudyEntry& study : studies()) {
    if (!study.timed) continue;
    const StudyReport report = study.run({true});
    for (const auto& row : report.rows) EXPECT_EQ(row.size(), report.columns.size());
    EXPECT_FALSE(report.claims.empty());
  }
}

}  // namespace
}  // namespace traceraft
