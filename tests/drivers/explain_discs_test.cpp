// `traceraft explain` on series by rafts that are discs: membranes that flow.
#include <gtest/gtest.h>

#include <memory>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;
using testing::json_of;
using testing::ProgramEnd;
using testing::traceraft;

const std::string kVesicle = " --model discs --case guv-2to1 --initial discs:number=60",
                  kFacts = TRACERAFT_ROOT "/verification/data/published/guv-2to1.toml";

// Vesicles of 4 nPa s m, measured as those of the paper were.
class ExplainDiscsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<testing::TemporaryFolder>();
    run("ensemble" + kVesicle +
        " --diffusion 5e-6 --t-end 1700 --no-fields --runs 12 --first-seed 101 --quiet --effect "
        "\"flow:membrane-viscosity=4,temperature=292\" --out " +
        in("truth").string());
    run("data draw " + in("d").string() + " --seed 1 --facts " + kFacts + " --ensemble " +
        in("truth").string());
    run(command("out"));
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static void run(const std::string& command) {
    const ProgramEnd end = traceraft(command);
    ASSERT_EQ(end.code, 0) << end.output;
  }
  static fs::path in(const std::string& name) { return folder_->path / name; }
  // Flow and uptake are looked for. D is known: another D would do nearly what flow does.
  static std::string command(const std::string& out) {
    return "explain --series " + in("d").string() + kVesicle +
           " --diffusion 5e-6 --diffusion-error 0.1 --runs 6 --replicates 49 --quiet --without "
           "bulk-mobility,line-tension,mobility-contrast,mobility-exponent --out " +
           in(out).string();
  }

  static std::unique_ptr<testing::TemporaryFolder> folder_;
};
std::unique_ptr<testing::TemporaryFolder> ExplainDiscsTest::folder_;

TEST_F(ExplainDiscsTest, NamesBrownianMotionWithItsViscosity) {
  const auto verdict = json_of(in("out/verdict.json"));
  EXPECT_EQ(verdict["effect"], "flow") << verdict.dump(2);
  const auto viscosity = verdict["parameters"]["flow.membrane-viscosity"];
  EXPECT_EQ(viscosity["unit"], "nPa s m");
  EXPECT_GT(viscosity["value"], 4 / 3.0);
  EXPECT_LT(viscosity["value"], 4 * 3.0);
  EXPECT_NEAR(verdict["parameters"]["flow.temperature"]["value"], 273.15 + 25, 1e-9);
  EXPECT_TRUE(verdict["parameters"]["flow.temperature"]["sigma"].is_null());
}

TEST_F(ExplainDiscsTest, SaysWhatTheEffectMakesOfTheGap) {
  const auto series = json_of(in("out/series.json"));
  ASSERT_EQ(series["scores"].size(), 2u);
  const auto& flow = series["scores"][0];
  EXPECT_EQ(flow["effect"], "flow");
  EXPECT_GT(flow["high"], flow["low"]);
  EXPECT_GT(flow["trend_p"], 0.02);
  const auto level = [&](const char* offsets) {
    return std::fabs(series[offsets][0]["level_deviations"].get<double>());
  };
  EXPECT_LT(level("best_offsets"), level("offsets"));
  // Both ends of D are those of what is known of it, or within.
  for (const char* end : {"low", "high"})
    if (const auto bound = series["diffusion_range"][end]; !bound.is_null()) {
      EXPECT_GT(bound, 5e-6 / 1.5);
      EXPECT_LT(bound, 5e-6 * 1.5);
    }
}

TEST_F(ExplainDiscsTest, WritesAModelThatRuns) {
  run("run --config " + in("out/model.toml").string() + " --t-end 1 --no-fields --quiet --out " +
      in("found").string());
  EXPECT_TRUE(fs::exists(in("found/summary.json")));
}

TEST_F(ExplainDiscsTest, FieldsAreNoDiscs) {
  EXPECT_TRUE(testing::refuses(
      traceraft("explain --data " + in("d").string() + " --model disc --out " + in("x").string()),
      "--model: "));
}

}  // namespace
}  // namespace traceraft
