// `traceraft hide` and `traceraft campaign` as their users run them.
#include <gtest/gtest.h>

#include "backends/posix/durable_file.hpp"
#include "drivers/campaign/hidden_case.hpp"
#include "drivers/input/field_dataset.hpp"
#include "kernel/core/error.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;
using testing::names;
using testing::refuses;

class HideTest : public ::testing::Test {
 protected:
  testing::ProgramEnd hide(const std::string& options) const {
    return testing::traceraft("hide --epsilon 1 --raft-fraction 0.5 --cells 14 --truth-cells 16 " +
                              options + " --snapshots 3 --points 300 --out " +
                              (folder.path / "riddle").string());
  }
  testing::TemporaryFolder folder;
};

TEST_F(HideTest, WritesMeasurementsAndSealsTheirTruth) {
  const auto end = hide("--effects uptake,gravity --seed 5 --diffusion-ratio 1.2 --stated 2");
  ASSERT_EQ(end.code, 0) << end.output;
  const campaign::HiddenTruth truth = campaign::open_truth(folder.path / "riddle");
  ASSERT_EQ(truth.effects.size(), 2u);
  EXPECT_EQ(truth.effects[0].effect, "uptake");
  EXPECT_EQ(truth.effects[1].effect, "gravity");
  EXPECT_EQ(truth.diffusion_ratio, 1.2);
  const input::FieldDataset data = input::read_field_dataset(folder.path / "riddle" / "data");
  ASSERT_EQ(data.vesicles.front().snapshots.size(), 3u);
  // Every second snapshot states another noise than it has.
  const double stated[] = {1, 2, 1};
  for (int k = 0; k < 3; ++k) {
    const assimilation::FieldSnapshot& snapshot = data.vesicles.front().snapshots[k];
    EXPECT_EQ(snapshot.points.size(), 300u);
    EXPECT_NEAR(snapshot.deviation[0], stated[k] * truth.noise, 1e-5 * truth.noise) << k;
  }
  // Nothing that the search reads tells what was hidden.
  for (const char* file : {"model.toml", "data/dataset.toml"}) {
    const std::string text = testing::content(folder.path / "riddle" / file);
    EXPECT_EQ(text.find("uptake:"), std::string::npos) << file;
    EXPECT_EQ(text.find("gravity:"), std::string::npos) << file;
  }
  EXPECT_EQ(hide("--effects none").code, 2);  // the folder is taken
}

TEST_F(HideTest, SeesAChangedTruth) {
  // Files of an attempt that was killed while it wrote more snapshots.
  fs::create_directories(folder.path / "riddle" / "data");
  posix::write_durably(folder.path / "riddle" / "truth.json", "{}\n");
  posix::write_durably(folder.path / "riddle" / "data" / "snapshot_004.csv", "x,y,z,c\n");
  ASSERT_EQ(hide("--effects none --seed 5").code, 0);
  EXPECT_FALSE(fs::exists(folder.path / "riddle" / "data" / "snapshot_004.csv"));
  const fs::path truth = folder.path / "riddle" / "truth.json";
  EXPECT_TRUE(campaign::open_truth(folder.path / "riddle").effects.empty());
  std::string text = testing::content(truth);
  text.replace(text.find("\"diffusion_ratio\": 1.0"), 11, "\"diffusion_ratio\": 1.1");
  posix::write_durably(truth, text);
  EXPECT_THROW(campaign::open_truth(folder.path / "riddle"), IoError);
}

TEST_F(HideTest, RefusesWhatCannotBeHidden) {
  EXPECT_TRUE(refuses(hide("--effects gravitty"), "'gravity'"));
  EXPECT_EQ(hide("--effects none --first 2 --last 1").code, 2);
  EXPECT_EQ(hide("--effects gravity,gravity").code, 2);
  EXPECT_TRUE(refuses(hide("--effects thermal"), "thermal"));
  EXPECT_EQ(hide("--effects none,gravity").code, 2);
  for (const char* effects : {"none", "gravity"}) {
    const auto end = testing::traceraft(
        "hide --epsilon 1 --raft-fraction 0.16 --cells 14 --truth-cells 16 --snapshots 3 --points "
        "300 --effects " +
        std::string(effects) + " --out " + (folder.path / "dissolved").string());
    EXPECT_TRUE(refuses(end, "no rafts"));
  }
  EXPECT_EQ(testing::traceraft("hide --cells 40 --truth-cells 40 --out " +
                               (folder.path / "coarse").string())
                .code,
            2);
}

// Small and coarse: what is tested is that everything fits together.
TEST(CampaignTest, CountsWhatWasFoundAndGoesOn) {
  const testing::TemporaryFolder folder;
  const fs::path out = folder.path / "campaign";
  const std::string command =
      "campaign --groups naming,null --cases 1 --epsilon 1 --cells 12 "
      "--points 500 --replicates 49 --most-effects 1 --out " +
      out.string();
  const auto begin = testing::traceraft(command);
  ASSERT_EQ(begin.code, 0) << begin.output;
  const std::string first = testing::content(out / "cases" / "null-000" / "score.json");
  nlohmann::json before = testing::json_of(out / "cases" / "null-000" / "score.json");
  const nlohmann::json score = before;
  EXPECT_EQ(score["hidden"], "");
  EXPECT_EQ(score["outcome"] == "right", score["effect"] == "");
  EXPECT_GT(score["heldout"]["floor"], 0);
  const std::string summary = testing::content(out / "summary.csv");
  EXPECT_TRUE(names(summary, "naming,1,"));
  EXPECT_TRUE(names(summary, "null,1,"));

  // A case whose end was not seen goes on from the last refit of its search.
  for (const char* file : {"score.json", "explain/verdict.json"})
    fs::remove(out / "cases" / "naming-000" / file);
  const fs::path log = out / "cases" / "naming-000.log";
  const long lines_before = testing::lines_of(log);
  const auto again = testing::traceraft(command);
  ASSERT_EQ(again.code, 0) << again.output;
  EXPECT_TRUE(fs::exists(out / "cases" / "naming-000" / "score.json"));
  // Every step is told in a line of the log, which goes on.
  EXPECT_LT(testing::lines_of(log) - lines_before, lines_before) << testing::content(log);
  EXPECT_TRUE(refuses(testing::traceraft(command + " --seed 2"), "--out: " + out.string()));
  EXPECT_EQ(testing::traceraft("campaign --out " + out.string()).code, 0);
  EXPECT_EQ(testing::content(out / "cases" / "null-000" / "score.json"), first);

  // Elsewhere these two need not be repeated.
  const fs::path other = folder.path / "other";
  const std::string there = "campaign --elsewhere " + out.string() + " --out " + other.string();
  EXPECT_EQ(testing::traceraft(there + " --seed 3").code, 2);
  const auto joined = testing::traceraft(there);
  ASSERT_EQ(joined.code, 0) << joined.output;
  EXPECT_TRUE(fs::is_empty(other / "cases"));
  EXPECT_EQ(testing::content(other / "cases.csv"), testing::content(out / "cases.csv"));
  nlohmann::json plan = testing::json_of(other / "plan.json");
  plan["seed"] = 2;
  posix::write_durably(other / "plan.json", plan.dump());
  EXPECT_TRUE(refuses(testing::traceraft(there), "plan"));

  // A search that no longer fits is made again.
  posix::write_durably(out / "cases" / "null-000" / "explain" / "search.json", "{}");
  fs::remove(out / "cases" / "null-000" / "score.json");
  ASSERT_EQ(testing::traceraft(command).code, 0);
  nlohmann::json after = testing::json_of(out / "cases" / "null-000" / "score.json");
  before.erase("seconds");
  after.erase("seconds");
  EXPECT_EQ(after, before);
}

TEST(CampaignTest, RefusesUnknownGroups) {
  EXPECT_TRUE(refuses(testing::traceraft("campaign --groups nameing"), "'naming'"));
}

}  // namespace
}  // namespace traceraft
