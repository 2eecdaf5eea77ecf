// `traceraft explain` on series, as its user runs it: simulations are made once and serve all data.
#include <gtest/gtest.h>

#include <memory>

#include "backends/posix/durable_file.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;
using testing::content;
using testing::json_of;
using testing::ProgramEnd;
using testing::refuses;
using testing::traceraft;

const std::string kMeasured = TRACERAFT_ROOT "/verification/data/synthetic/guv-3to1";

// One set of simulations for all tests of the suite, which leave it as it was.
class ExplainSeriesTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<testing::TemporaryFolder>();
    // Coarse, and with a raft that is one from the start, which no measured vesicle is.
    posix::write_durably(in("model.toml"), "epsilon = 0.8\ncells = 16\nraft-fraction = 0.3\n");
    made_ = std::make_unique<ProgramEnd>(traceraft(command("model.toml")));
    ASSERT_EQ(made_->code, 0) << made_->output;
    ASSERT_EQ(
        traceraft("data draw " + in("others").string() +
                  " --seed 2 --facts " TRACERAFT_ROOT "/verification/data/published/guv-3to1.toml")
            .code,
        0);
  }
  static void TearDownTestSuite() {
    made_.reset();
    folder_.reset();
  }

  static fs::path in(const std::string& name) { return folder_->path / name; }
  // The effects that are looked for are Ohta-Kawasaki and uptake.
  static std::string command(const std::string& model) {
    return "explain --data " + kMeasured + " --runs 3 --replicates 49 " + kWithout + " --out " +
           in("out").string() + " --model " + in(model).string();
  }
  // Other vesicles, held against simulations that are there.
  static std::string of_others(const std::string& out, const fs::path& ensembles) {
    return "explain --series " + in("others").string() + " --replicates 49 --out " +
           in(out).string() + " " + kWithout + " --model " + in("model.toml").string() +
           " --ensembles " + ensembles.string();
  }
  static fs::path simulations() { return in("out/ensembles"); }
  static fs::file_time_type time_of_first_run() {
    return fs::last_write_time(simulations() / "base/runs/seed-1");
  }

  static const std::string kWithout;
  static std::unique_ptr<testing::TemporaryFolder> folder_;
  static std::unique_ptr<ProgramEnd> made_;
};
const std::string ExplainSeriesTest::kWithout =
    "--without allen-cahn,asymmetry,bulk-mobility,cooling,exchange,flow,gravity,line-tension,"
    "mobility-contrast,mobility-exponent";
std::unique_ptr<testing::TemporaryFolder> ExplainSeriesTest::folder_;
std::unique_ptr<ProgramEnd> ExplainSeriesTest::made_;

TEST_F(ExplainSeriesTest, SaysWhatSeriesTell) {
  const auto series = json_of(in("out/series.json"));
  EXPECT_EQ(series["verdict"], "unnamed") << series.dump(2);
  EXPECT_EQ(series["vesicles"], 17);
  ASSERT_EQ(series["scores"].size(), 2u);
  for (const auto& score : series["scores"])
    EXPECT_TRUE(score["vesicles_needed"].is_null() || score["vesicles_needed"] > 0) << score;
  EXPECT_EQ(series["exponents"][0]["model"], "synthetic data");
  EXPECT_NEAR(series["exponents"][0]["b"], -0.37, 0.1);  // as published
  EXPECT_TRUE(testing::names(content(in("out/series.html")), "SYNTHETIC"));
}

// The files of an explanation from fields, as far as series tell what is in them.
TEST_F(ExplainSeriesTest, WritesAVerdictAndNoModelWhereNothingIsNamed) {
  const auto verdict = json_of(in("out/verdict.json"));
  EXPECT_EQ(verdict["verdict"], "unnamed");
  EXPECT_TRUE(verdict["effect"].is_null());
  EXPECT_EQ(verdict["alternatives"].size(), 2u);
  EXPECT_FALSE(fs::exists(in("out/model.toml")));
}

TEST_F(ExplainSeriesTest, SimulatesOnce) {
  const auto before = time_of_first_run();
  const std::string series = content(in("out/series.json"));
  const fs::path plan = simulations() / "base/plan.json";
  const std::string planned = content(plan);
  posix::write_durably(plan, "{");  // which is written anew
  const ProgramEnd again = traceraft(command("model.toml"));
  EXPECT_EQ(again.code, 0) << again.output;
  EXPECT_EQ(content(plan), planned);
  EXPECT_EQ(time_of_first_run(), before);
  EXPECT_EQ(content(in("out/series.json")), series);
}

TEST_F(ExplainSeriesTest, HoldsOtherVesiclesAgainstTheSameSimulations) {
  const auto before = time_of_first_run();
  const auto planned = fs::last_write_time(simulations() / "base/plan.json");
  for (const char* time : {"first", "once more"}) {
    const ProgramEnd compared = traceraft(of_others("second", simulations()));
    ASSERT_EQ(compared.code, 0) << time << compared.output;
    EXPECT_NE(content(in("second/series.json")), content(in("out/series.json")));
    EXPECT_FALSE(fs::exists(in("second/ensembles")));
  }
  EXPECT_EQ(fs::last_write_time(simulations() / "base/plan.json"), planned) << "others may read it";
  EXPECT_EQ(time_of_first_run(), before);
}

TEST_F(ExplainSeriesTest, TakesNoSimulationsThatAreOthers) {
  EXPECT_TRUE(refuses(traceraft(of_others("third", in("others"))), "--ensembles: "));
  const fs::path file = simulations() / "strengths.json";
  const std::string kept = content(file);
  nlohmann::json foreign = json_of(file);
  foreign["identity"] = "another";
  // The file as earlier versions of the program wrote it, and of another model.
  const nlohmann::json older{{"identity", json_of(file)["identity"]},
                             {"looks", json_of(file)["looks"]},
                             {"strengths", {{"uptake", {1.0}}}}};
  for (const nlohmann::json& strengths : {older, foreign}) {
    posix::write_durably(file, strengths.dump());
    EXPECT_TRUE(refuses(traceraft(of_others("third", simulations())),
                        "--ensembles: " + simulations().string()));
  }
  posix::write_durably(file, kept);
  EXPECT_FALSE(fs::exists(in("third")));
  for (const char* strengths :
       {"5", "\"x\"", "{\"uptake\": [[\"a\"]]}", "{\"uptake\": [null]}", "{\"uptake\": []}"}) {
    nlohmann::json damaged = json_of(file);
    damaged["levels"] = nlohmann::json::parse(strengths);
    posix::write_durably(file, damaged.dump());
    const ProgramEnd end = traceraft(of_others("fourth", simulations()));
    EXPECT_EQ(end.code, 4) << strengths << end.output;
    posix::write_durably(file, kept);
  }
}

TEST_F(ExplainSeriesTest, DoesNotMixModelsInAFolder) {
  posix::write_durably(in("other.toml"), "epsilon = 0.8\ncells = 16\nraft-fraction = 0.4\n");
  EXPECT_TRUE(refuses(traceraft(command("other.toml")), in("out").string()));
}

TEST_F(ExplainSeriesTest, RefusesModelsThatSeriesCannotTell) {
  EXPECT_TRUE(
      refuses(traceraft(command("model.toml") + " --effect gravity:strength=0.1"), "--effect"));
  const std::string torus = "epsilon = 0.8\ncells = 16\nsurface = \"torus\"\n";
  const auto explain_on = [](const std::string& model) {
    posix::write_durably(in("torus.toml"), model);
    return traceraft("explain --series " + kMeasured + " --model " + in("torus.toml").string() +
                     " --out " + in("none").string());
  };
  EXPECT_TRUE(refuses(explain_on(torus + "raft-fraction = 0.1\n"), "torus.toml:3"));
  // The raft fraction of a membrane that nobody has named is that of the default case.
  EXPECT_TRUE(refuses(explain_on(torus), "guv-2to1"));
  EXPECT_FALSE(fs::exists(in("none")));
}

}  // namespace
}  // namespace traceraft
