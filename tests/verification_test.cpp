// The quick form of every verification study holds.
#include <gtest/gtest.h>

#include "verification/measure/bench.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft {
namespace {

class StudyTest : public ::testing::TestWithParam<std::string> {};

TEST_P(StudyTest, Holds) {
  const StudyReport report = studies().find(GetParam()).run(Bench({true, "", "", 1}));
  if (!report.skipped.empty()) GTEST_SKIP() << report.skipped;
  EXPECT_FALSE(report.claims.empty());
  for (const Claim& claim : report.claims)
    EXPECT_TRUE(claim.holds()) << claim.what << ": " << claim.measured << " is not in ["
                               << claim.low << ", " << claim.high << "]";
  for (const Table& table : report.tables)
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size()) << table.name;
}

std::vector<std::string> studies_of_all() {
  std::vector<std::string> names;
  for (const StudyEntry& study : studies())
    if (!study.by_name_only) names.push_back(study.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Quick, StudyTest, ::testing::ValuesIn(studies_of_all()),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& ch : name)
                             if (ch == '-') ch = '_';
                           return name;
                         });

// Timed studies run; what they measure is not judged here.
TEST(TimedStudies, Run) {
  for (const char* name : {"cost", "step-cost"})
    EXPECT_FALSE(studies().find(name).run(Bench({true, "", "", 1})).claims.empty()) << name;
}

}  // namespace
}  // namespace traceraft
