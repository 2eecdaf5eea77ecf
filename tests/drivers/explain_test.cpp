// `traceraft explain` as its user runs it, on measurements whose truth it is not told.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "drivers/explain/field_dataset.hpp"
#include "kernel/physics/units.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "verification/explain/blind_case.hpp"

namespace traceraft {
namespace {

class ExplainTest : public ::testing::Test {
 protected:
  // What a vesicle of 5 µm with ε = 0.75 µm and D = 1e-5 cm²/s would show.
  BlindCase draw(const std::string& effect) const {
    BlindRequest request;
    request.base = bench_model("degenerate", 0.15);
    if (!effect.empty()) request.effects = {effect};
    request.cells = 28;
    request.first = 30;
    request.last = 140;
    request.snapshots = 5;
    request.points = 1500;
    request.seed = 2;
    BlindCase drawn = draw_blind_case(request);
    FieldDataset data;
    data.name = "drawn";
    data.synthetic = true;
    data.radius_um = 5;
    data.vesicles = {drawn.series};
    for (FieldSnapshot& snapshot : data.vesicles[0].snapshots) snapshot.time *= Units().time();
    write_field_dataset(folder.path / "data", data, "drawn by a test");
    return drawn;
  }
  nlohmann::json explain() const {
    const auto end =
        testing::traceraft("explain --data " + (folder.path / "data").string() +
                           " --epsilon 0.75 --cells 20 --effects 1 --replicates 49 --out " +
                           (folder.path / "out").string());
    EXPECT_EQ(end.code, 0) << end.output;
    return nlohmann::json::parse(testing::content(folder.path / "out" / "verdict.json"));
  }
  testing::TemporaryFolder folder;
};

TEST_F(ExplainTest, NamesWhatWasHidden) {
  const BlindCase drawn = draw("uptake");
  const nlohmann::json verdict = explain();
  EXPECT_EQ(verdict["effect"], "uptake") << verdict.dump(2);
  const nlohmann::json& rate = verdict["parameters"]["uptake.rate"];
  const double truth = drawn.truth[0].values[0] / Units().time();
  EXPECT_NEAR(rate["value"], truth, 4 * rate["sigma"].get<double>());
  EXPECT_LT(rate["sigma"], 0.2 * truth);
  EXPECT_NEAR(verdict["noise"], drawn.noise, 0.05 * drawn.noise);
  // What is left is what is to be expected of noise.
  const auto gap = [&](const char* which) { return verdict["gap"][which]["train"].get<double>(); };
  EXPECT_NEAR(gap("named"), gap("floor"), 0.03 * gap("floor"));
  EXPECT_GT(gap("base"), 1.05 * gap("floor"));
  EXPECT_FALSE(verdict["where"].is_null());
  // The model that it has written is one.
  const auto end =
      testing::traceraft("run --config " + (folder.path / "out" / "model.toml").string() +
                         " --t-end 0.01 --out " + (folder.path / "run").string());
  EXPECT_EQ(end.code, 0) << end.output;
}

TEST_F(ExplainTest, NamesNothingWhereNothingIsHidden) {
  draw("");
  const nlohmann::json verdict = explain();
  EXPECT_TRUE(verdict["effect"].is_null()) << verdict.dump(2);
  EXPECT_NEAR(verdict["parameters"]["diffusion"]["value"], 1e-5, 0.05e-5);
}

TEST_F(ExplainTest, RefusesWhatItCannotUse) {
  const std::string data = " --data " + (folder.path / "data").string();
  EXPECT_EQ(testing::traceraft("explain").code, 2);
  EXPECT_EQ(testing::traceraft("explain" + data).code, 2);
}

}  // namespace
}  // namespace traceraft
