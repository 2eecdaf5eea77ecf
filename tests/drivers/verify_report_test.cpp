// The files that a verification leaves behind, and when it fails.
#include "drivers/verify/verify_report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "backends/posix/durable_file.hpp"
#include "kernel/core/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

verify::StudyResult result_with(std::vector<studies::Claim> claims) {
  verify::StudyResult result;
  result.study = {"example", "an example", {}};
  result.report.claims = std::move(claims);
  result.report.tables = {
      {"numbers", {"name", "value"}, {{"a, \"quoted\" one", 0.1}, {"nothing", std::nan("")}}}};
  result.report.charts = {{"A chart", "x", "y", true, true, {{"points", {{1, 2}, {3, 4}}}}}};
  result.report.notes = {"A note with <angles>."};
  return result;
}

TEST(Claims, HoldWithinTheirInterval) {
  EXPECT_TRUE(studies::claim_near("x", 2.1, 2, 0.15).holds());
  EXPECT_FALSE(studies::claim_near("x", 2.2, 2, 0.15).holds());
  EXPECT_TRUE(studies::claim_at_most("x", -5, 1).holds());
  EXPECT_FALSE(studies::claim_at_most("x", 1.1, 1).holds());
  EXPECT_FALSE(studies::claim_at_most("x", std::nan(""), 1).holds());
  EXPECT_FALSE(studies::claim_between("x", 0.9, 1, 2).holds());
}

TEST(Verdicts, AreThoseOfTheWorstClaim) {
  const studies::Claim good = studies::claim_at_most("good", 0, 1),
                       bad = studies::claim_at_most("bad", 2, 1);
  EXPECT_EQ(result_with({good}).outcome(), verify::StudyOutcome::holds);
  EXPECT_EQ(result_with({good, bad, good}).outcome(), verify::StudyOutcome::fails);
  EXPECT_EQ(result_with({}).outcome(), verify::StudyOutcome::fails)
      << "a study without claims shows nothing";
  verify::StudyResult failed = result_with({good});
  failed.failure = "it broke";
  EXPECT_EQ(failed.outcome(), verify::StudyOutcome::fails);
  verify::StudyResult skipped;
  skipped.report.skipped = "not built in";
  EXPECT_EQ(skipped.outcome(), verify::StudyOutcome::not_measured);
}

TEST(VerifyReport, ClaimsAreRowsForPeople) {
  studies::Claim near = studies::claim_near("order", 1.98, 2, 0.25);
  near.uncertainty = 0.03;
  const auto rows = verify::claim_rows({near, studies::claim_at_most("drift", 2e-12, 1e-12),
                                        studies::claim_at_least("steps", 23, 10)});
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0],
            (std::vector<std::string>{"claim", "measured", "expected", "tolerance", "verdict"}));
  EXPECT_EQ(rows[1], (std::vector<std::string>{"order", "1.98 +- 0.03", "2", "+- 0.25", "holds"}));
  EXPECT_EQ(rows[2], (std::vector<std::string>{"drift", "2e-12", "at most 1e-12", "", "FAILS"}));
  EXPECT_EQ(rows[3], (std::vector<std::string>{"steps", "23", "at least 10", "", "holds"}));
}

TEST(VerifyReport, FilesHoldAllOfIt) {
  const testing::TemporaryFolder folder;
  const std::vector<verify::StudyResult> results = {
      result_with({studies::claim_near("x", 1, 1, 0.1)}),
      result_with({studies::claim_at_most("y", INFINITY, 1)})};
  verify::write_study(folder.path, results[0], "this program");
  EXPECT_EQ(posix::read_file(folder.path / "example-numbers.csv", 1 << 20),
            "name,value\n\"a, \"\"quoted\"\" one\",0.1\nnothing,nan\n");
  (void)verify::write_verification(
      folder.path, {"traceraft verify example", "2 threads.", "this program"}, results);
  const auto json = nlohmann::json::parse(posix::read_file(folder.path / "verify.json", 1 << 20));
  EXPECT_EQ(json["command"], "traceraft verify example");
  EXPECT_EQ(json["studies"][0]["verdict"], "holds");
  EXPECT_EQ(json["studies"][0]["claims"][0]["expected"], 1.0);
  EXPECT_EQ(json["studies"][0]["tables"]["numbers"]["rows"][0][1], 0.1);
  EXPECT_EQ(json["studies"][1]["verdict"], "FAILS");
  EXPECT_TRUE(json["studies"][1]["claims"][0]["measured"].is_null());
  const std::string page = posix::read_file(folder.path / "verify.html", 1 << 24);
  for (const char* part : {"A note with &lt;angles&gt;.", "traceraft verify example", "FAILS"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
}

TEST(VerifyResult, IsReadBackWhole) {
  const testing::TemporaryFolder folder;
  const verify::StudyResult written = result_with({studies::claim_near("x", 1, 1, 0.1, 0.02),
                                                   studies::claim_at_most("y", INFINITY, 1),
                                                   studies::claim_between("z", 0.1 + 0.2, -1, 2)});
  verify::write_study(folder.path, written, "this program");
  EXPECT_FALSE(verify::measured_before(folder.path, written.study, "another program"));
  const auto read = verify::measured_before(folder.path, written.study, "this program");
  ASSERT_TRUE(read);
  EXPECT_EQ(verify::to_json(*read, "this program"), verify::to_json(written, "this program"));
  EXPECT_FALSE(read->report.claims[1].holds());
  EXPECT_EQ(read->report.claims[2].measured, 0.1 + 0.2);
  EXPECT_TRUE(std::isnan(read->report.tables[0].rows[1][1].number));

  verify::StudyResult failed = written;
  failed.failure = "it broke";
  verify::write_study(folder.path, failed, "this program");
  EXPECT_FALSE(verify::measured_before(folder.path, written.study, "this program"))
      << "what failed is tried again";
  posix::write_durably(folder.path / "example.json", "{\"study\": 1}");
  EXPECT_THROW(verify::measured_before(folder.path, written.study, "this program"), IoError);
}

TEST(VerifyReport, ADocumentHasItsFiguresBesideIt) {
  const testing::TemporaryFolder folder;
  const verify::VerificationContext context{"traceraft verify example", "2 threads.",
                                            "this program"};
  const std::vector<verify::StudyResult> results = {
      result_with({studies::claim_near("x", 1, 1, 0.1)})};
  const bool drawn = verify::write_verification(folder.path, context, results).empty();
  verify::write_document(folder.path / "report.md", folder.path, context, results);
  const std::string text = posix::read_file(folder.path / "report.md", 1 << 20);
  for (const char* part : {"# Verification", "    traceraft verify example\n", "| x | 1 | 1 |",
                           "| a, \"quoted\" one | 0.1 |"})
    EXPECT_NE(text.find(part), std::string::npos) << part << text;
  EXPECT_EQ(text.find("![A chart](report/example-1.svg)") != std::string::npos, drawn);
  if (drawn) {
    EXPECT_TRUE(fs::exists(folder.path / "report/example-1.svg"));
    EXPECT_FALSE(fs::exists(folder.path / "report/example-1.gp"));
  }
}

}  // namespace
}  // namespace traceraft
