// The report of a campaign, on scores that are written down by hand.
#include "drivers/campaign/campaign_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "backends/posix/durable_file.hpp"
#include "drivers/output/text_table.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

campaign::CaseScore score(int number, const std::string& hidden, const std::string& found,
                          campaign::CaseOutcome outcome, double deviations) {
  // The named model closes 5² − 4² of 5² − 3², the placebo nothing.
  return {{"naming", number}, hidden, "named", found, outcome, 0.01 * number,
          deviations,         0.005,  5,       4,     5,       3,
          10.0 * number};
}

using Scores = std::vector<campaign::CaseScore>;

Scores scores() {
  return {score(1, "gravity", "gravity", campaign::CaseOutcome::right, 1.9),
          score(2, "uptake", "exchange", campaign::CaseOutcome::in_class, std::nan("")),
          score(3, "uptake", "gravity", campaign::CaseOutcome::wrong, -2.1),
          score(5, "cooling", "cooling", campaign::CaseOutcome::right, -0.3)};
}

TEST(CampaignReport, SumsUpGroups) {
  const auto rows = output::table_rows(campaign::summary_of(scores()));
  ASSERT_EQ(rows.size(), 2u);
  const auto of = [&](const std::string& column) {
    for (std::size_t k = 0; k < rows[0].size(); ++k)
      if (rows[0][k] == column) return rows[1][k];
    return std::string("no such column");
  };
  EXPECT_EQ(of("group"), "naming");
  EXPECT_EQ(std::stod(of("cases")), 4);
  EXPECT_EQ(std::stod(of("right")), 2);
  EXPECT_EQ(std::stod(of("in class")), 1);
  EXPECT_EQ(std::stod(of("missed")), 0);
  EXPECT_EQ(std::stod(of("wrong")), 1);
  EXPECT_NEAR(std::stod(of("median error")), 0.025, 1e-4);
  EXPECT_NEAR(std::stod(of("coverage")), 2 / 3.0, 1e-3);
  EXPECT_NEAR(std::stod(of("held-out gap / floor")), 4 / 3.0, 1e-3);
  EXPECT_NEAR(std::stod(of("placebo / named")), 5 / 4.0, 1e-4);
  EXPECT_NEAR(std::stod(of("closed")), 9 / 16.0, 1e-4);
  EXPECT_NEAR(std::stod(of("s per case")), 25, 1e-9);
}

// A case that came to no verdict is one of its group, not one that never was.
TEST(CampaignReport, CountsWhatFailed) {
  const auto rows = output::table_rows(campaign::summary_of(
      scores(), {{{"naming", 4}, "no forecast"}, {{"two", 1}, "no forecast"}}));
  ASSERT_EQ(rows.size(), 3u);
  const auto column = [&](const std::string& name) {
    return std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin();
  };
  for (const auto& [row, cases] : {std::pair(1, 5), std::pair(2, 1)}) {
    EXPECT_EQ(std::stod(rows[row][column("cases")]), cases);
    EXPECT_EQ(std::stod(rows[row][column("failed")]), 1);
  }
  EXPECT_EQ(rows[2][0], "two");
}

TEST(CampaignReport, TellsClassesFromConfusion) {
  const auto rows = output::table_rows(campaign::confusion_of(scores()));
  ASSERT_EQ(rows.size(), 4u);
  const std::vector<std::string> columns{"hidden \\ found", "cooling", "exchange (in class)",
                                         "gravity"};
  EXPECT_EQ(rows[0], columns);
  EXPECT_EQ(rows[3][0], "uptake");
  EXPECT_EQ(rows[3][1], "");
  EXPECT_EQ(std::stod(rows[3][2]), 1);
  EXPECT_EQ(std::stod(rows[3][3]), 1);
}

TEST(CampaignReport, ShowsWhatIsSeenWhereNothingIs) {
  campaign::CaseScore none = score(1, "", "", campaign::CaseOutcome::right, std::nan(""));
  none.id.group = "null";
  none.verdict = "none";
  const auto rows = output::table_rows(campaign::confusion_of({none, none}));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0][1], "none");
  EXPECT_EQ(rows[1][0], "nothing");
  EXPECT_EQ(std::stod(rows[1][1]), 2);
}

TEST(CampaignReport, CountsPairsOnceInWhateverOrder) {
  const auto rows = output::table_rows(campaign::confusion_of(
      {score(1, "gravity + uptake", "uptake + gravity", campaign::CaseOutcome::right, 0),
       score(2, "uptake + gravity", "gravity + uptake", campaign::CaseOutcome::right, 0)}));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"hidden \\ found", "gravity + uptake"}));
  EXPECT_EQ(rows[1][0], "gravity + uptake");
  EXPECT_EQ(std::stod(rows[1][1]), 2);
}

// Cases that are kept, and carried on by another build.
TEST(CampaignReport, TellsWhichBuildsExplained) {
  const fs::path folder = fs::path(::testing::TempDir()) / "campaign-of-builds";
  fs::create_directories(folder);
  const campaign::CampaignFolder campaign(folder);
  Scores all = scores();
  for (campaign::CaseScore& one : all) one.program = "0000000a";
  campaign::write_campaign(campaign, all);
  EXPECT_EQ(posix::read_file(folder / "campaign.md", 1 << 20).find("Builds"), std::string::npos);
  all[2].program = "0000000b";
  all[3].program = "";
  campaign::write_campaign(campaign, all);
  const std::string text = posix::read_file(folder / "campaign.md", 1 << 20);
  for (const char* line : {"- 0000000a: 2\n", "- 0000000b: 1\n", "- not known: 1\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  const Scores again = campaign::read_cases(campaign.cases());
  ASSERT_EQ(again.size(), all.size());
  for (std::size_t k = 0; k < all.size(); ++k) EXPECT_EQ(again[k].program, all[k].program);
}

// Earlier tables do not say it.
TEST(CampaignReport, ReadsCasesOfNoKnownBuild) {
  const fs::path csv = fs::path(::testing::TempDir()) / "cases-of-no-build.csv";
  posix::write_durably(
      csv,
      "case,hidden,verdict,found,outcome,error,deviations,p,base gap,named gap,placebo "
      "gap,floor,seconds\nnull-000,,none,,right,,,0.9,0.3,0.3,,0.3,36\n");
  const Scores cases = campaign::read_cases(csv);
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_EQ(cases[0].program, "");
  EXPECT_EQ(cases[0].seconds, 36);
}

}  // namespace
}  // namespace traceraft
