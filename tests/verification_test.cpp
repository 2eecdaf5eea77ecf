// The quick form of every verification study holds.
#include <gtest/gtest.h>

#include <algorithm>

#include "verification/bench/bench.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft {
namespace {

class StudyTest : public ::testing::TestWithParam<std::string> {};

TEST_P(StudyTest, Holds) {
  const studies::StudyReport report =
      studies::studies().find(GetParam()).run(bench::Bench({true, "", "", 1}));
  if (!report.skipped.empty()) GTEST_SKIP() << report.skipped;
  EXPECT_FALSE(report.claims.empty());
  for (const studies::Claim& claim : report.claims)
    EXPECT_TRUE(claim.holds()) << claim.what << ": " << claim.measured << " is not in ["
                               << claim.low << ", " << claim.high << "]";
  for (const bench::Table& table : report.tables)
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size()) << table.name;
}

std::vector<std::string> studies_of_all() {
  std::vector<std::string> names;
  for (const studies::StudyEntry& study : studies::studies())
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

// Timed studies are tested by those of their numbers that are no times.
TEST(TimedStudies, MeshesGrowLikeTheSurface) {
  const studies::StudyReport report =
      studies::studies().find("cost").run(bench::Bench({true, "", "", 1}));
  ASSERT_EQ(report.tables.size(), 2u);
  EXPECT_EQ(report.tables[0].rows.size(), 2u);
  ASSERT_EQ(report.tables[1].rows.size(), 1u);  // flow: times and steps
  for (const bench::Cell& cell : report.tables[1].rows[0]) EXPECT_GT(cell.number, 0);
  const auto nodes = std::find_if(
      report.claims.begin(), report.claims.end(),
      [](const studies::Claim& c) { return c.what.find("nodes") != std::string::npos; });
  ASSERT_NE(nodes, report.claims.end());
  EXPECT_TRUE(nodes->holds()) << nodes->measured;
}

TEST(TimedStudies, StepsAreTheSameOnAnyNumberOfThreads) {
  const studies::StudyReport report =
      studies::studies().find("step-cost").run(bench::Bench({true, "", "", 1}));
  const bench::Table& table = report.tables.at(0);
  const auto at = [&](std::size_t row, const std::string& column) {
    const auto found = std::find(table.columns.begin(), table.columns.end(), column);
    EXPECT_NE(found, table.columns.end()) << column;
    return table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()));
  };
  ASSERT_EQ(table.rows.size(), 4u);
  for (const std::size_t row : {0, 2}) {  // block, and direct
    EXPECT_EQ(at(row, "threads").number, 1);
    EXPECT_EQ(at(row + 1, "threads").number, 2);
    EXPECT_GT(at(row, "steps").number, 0);
    EXPECT_GT(at(row, "iterations").number, 0);
    EXPECT_EQ(at(row, "iterations").number, at(row + 1, "iterations").number) << row;
    // The parts are of one thread, within the step.
    EXPECT_LE(
        at(row, "assembly_ms").number + at(row, "setup_ms").number + at(row, "solve_ms").number,
        at(row, "mean_ms").number)
        << row;
  }
}

}  // namespace
}  // namespace traceraft
