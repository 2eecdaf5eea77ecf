// The verdict of series, in files that other programs read.
#include "drivers/explain/series_verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/config/config_file.hpp"
#include "drivers/run/physical_model.hpp"
#include "tests/support/temporary_folder.hpp"
#include "verification/assimilation/forecast/candidates.hpp"

namespace traceraft {
namespace {

// R = 10 µm and D = 1e-5 cm²/s: R²/D is 0.1 s. The series say that it is half of that, with uptake
// a third.
class SeriesVerdictTest : public ::testing::Test {
 protected:
  SeriesVerdictTest() {
    model["radius"] = {"10", "--radius"};
    model["diffusion"] = {"1e-5", "--diffusion"};
    const auto score = [](const std::string& effect, double gain, double value) {
      selection::SeriesScore s{};
      s.effect = effect;
      s.gain = gain;
      s.null_mean = 1;
      s.ln_unit = std::log(0.1 / 3);
      s.value = value;
      s.sigma = 0.1 * value;
      s.telling = observations::Quantity::fraction;
      return s;
    };
    found.finding = selection::Finding::ambiguous;
    found.base.ln_unit = std::log(0.05);
    found.scores = {score("uptake", 30, 2e-3), score("cooling", 29, 1e-3),
                    score("gravity", 1, 1e-3)};
    found.named = {{"cooling", "uptake"}};
    found.offsets = {{observations::Quantity::fraction, 0.02, 4, 0.001, 1}};
    simulate("cooling", {5e-4});
    simulate("uptake", {1e-3});
    simulate("gravity", {1e-3});
  }
  void simulate(const std::string& effect, const std::vector<double>& coefficients) {
    ensembles.effects.push_back({{assimilation::find_candidate(effect)->term(coefficients)}});
  }
  input::Json json(const std::string& file) const {
    return input::from_json(folder.path / file, [](const input::Json& content) { return content; });
  }

  const testing::TemporaryFolder folder;
  config::GivenValues model;
  selection::SeriesExplanation found{};
  explain::SeriesEnsembles ensembles;
};

TEST_F(SeriesVerdictTest, NamesWhatExplainsMostInPhysicalUnits) {
  explain::write_series_verdict(folder.path, "", model, ensembles, found,
                                {likelihood::UnitPrior::within_factor(0.1, 8)});
  const input::Json verdict = json("verdict.json");
  EXPECT_EQ(verdict["verdict"], "ambiguous");
  EXPECT_EQ(verdict["effect"], "uptake");
  EXPECT_EQ(verdict["class"], input::Json({"uptake", "cooling"}));
  EXPECT_NEAR(verdict["parameters"]["uptake.rate"]["value"].get<double>(), 2e-3 * 30, 1e-6);
  EXPECT_NEAR(verdict["parameters"]["uptake.rate"]["sigma"].get<double>(), 2e-4 * 30, 1e-6);
  EXPECT_EQ(verdict["parameters"]["uptake.rate"]["unit"], "1/s");
  EXPECT_NEAR(verdict["parameters"]["diffusion"]["value"].get<double>(), 3e-5, 1e-10);
  for (const char* gap : {"base", "named", "placebo", "floor"})
    EXPECT_TRUE(verdict["gap"][gap]["heldout"].is_null()) << gap;
  EXPECT_EQ(verdict["alternatives"][1], input::Json({{"effect", "cooling"}, {"score", 29.0}}));
  EXPECT_EQ(verdict["null"]["replicates"], 199);

  const config::Configuration named(config::read_config_file(folder.path / "model.toml"), {});
  EXPECT_NEAR(named.options().diffusion, 3e-5, 1e-10);
  const std::string effect = named.options().effect, name = "uptake:rate=";
  ASSERT_EQ(effect.substr(0, name.size()), name);
  EXPECT_NEAR(std::stod(effect.substr(name.size())), 0.06, 1e-6);
}

// A fitted strength may lie beyond what is possible.
TEST_F(SeriesVerdictTest, WritesAModelThatCanBeRun) {
  simulate("asymmetry", {0.5});
  found.scores.front().effect = "asymmetry";
  found.scores.front().value = 1e3;
  explain::write_series_verdict(folder.path, "", model, ensembles, found,
                                {likelihood::UnitPrior::within_factor(0.1, 8)});
  const config::Configuration named(config::read_config_file(folder.path / "model.toml"), {});
  EXPECT_EQ(run::physical_model(named).effects.size(), 1u);
}

TEST_F(SeriesVerdictTest, ATrendNamesNothing) {
  found.finding = selection::Finding::unnamed;
  found.named = {{"uptake"}};
  explain::write_series_verdict(folder.path, "", model, ensembles, found,
                                {likelihood::UnitPrior::within_factor(0.1, 8)});
  const input::Json verdict = json("verdict.json");
  EXPECT_TRUE(verdict["effect"].is_null());
  EXPECT_EQ(verdict["closest"], "uptake");
  EXPECT_TRUE(verdict["class"].empty());
  EXPECT_NEAR(verdict["parameters"]["diffusion"]["value"].get<double>(), 2e-5, 1e-10);
  EXPECT_FALSE(std::filesystem::exists(folder.path / "model.toml"));
}

// Parameters that were not looked for are said.
TEST_F(SeriesVerdictTest, SaysWhatWasAssumed) {
  simulate("exchange", {3e-3, 1e-3});
  found.scores.front().effect = "exchange";
  explain::write_series_verdict(folder.path, "", model, ensembles, found,
                                {likelihood::UnitPrior::within_factor(0.1, 8)});
  const input::Json parameters = json("verdict.json")["parameters"];
  EXPECT_NEAR(parameters["exchange.target"]["value"].get<double>(), 0.25, 1e-12);
  EXPECT_TRUE(parameters["exchange.target"]["sigma"].is_null());
  const input::Json series = explain::series_json({model, {}}, ensembles, found, {});
  EXPECT_NEAR(series["scores"][0]["assumed"]["target"]["value"].get<double>(), 0.25, 1e-12);
  EXPECT_TRUE(series["scores"][2]["assumed"].empty());
}

TEST_F(SeriesVerdictTest, SaysHowMeasurementsLieBesideTheModel) {
  const input::Json series = explain::series_json({model, {}}, ensembles, found, {});
  EXPECT_EQ(series["offsets"][0]["quantity"], "fraction");
  EXPECT_EQ(series["offsets"][0]["of"], "ln");
  EXPECT_EQ(series["offsets"][0]["level_deviations"], 4);
}

}  // namespace
}  // namespace traceraft
