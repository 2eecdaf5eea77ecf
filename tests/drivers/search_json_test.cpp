// A search as its file keeps it.
#include "drivers/explain/search_json.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "verification/bench/bench.hpp"

namespace traceraft {
namespace {

selection::Refit fit_of(const std::string& effect, double deviance) {
  selection::Refit fit;
  fit.hypothesis.parts = {{assimilation::find_candidate(effect).value(), {0.25}}};
  fit.random = {0.1, 0.2};
  fit.random_gain = 17;
  fit.deviance = deviance;
  fit.covariance = Eigen::MatrixXd::Identity(1, 1);
  return fit;
}

TEST(SearchJson, KeepsWhatARoundThatIsNotOverHas) {
  const problem::CahnHilliardModel base = bench::bench_model("degenerate", 0.2);
  selection::SearchState state;
  state.next = selection::SearchStep::replace;
  state.so_far.noise_model = {{{0.1, 0.2}}, {0.3}, {{{0.2, 0.3}, {0.4, 0.1}}, true, 0.07}};
  state.maps_at = {state.so_far.noise_model, 1.25, fit_of("uptake", 0).hypothesis};
  state.weighed = true;
  state.so_far.finding = selection::Finding::ambiguous;
  state.so_far.found = fit_of("uptake", 100);
  state.so_far.rivals = {fit_of("gravity", 101)};
  state.so_far.excluded = {{"exchange", 12}};
  state.so_far.changes = {{selection::ModelChange::left_gap, "exchange", "uptake"},
                          {selection::ModelChange::is_none, "gravity", ""}};
  selection::Round round{{base, 1.5, {}, {}},     {}, fit_of("gravity", 120),
                         {fit_of("uptake", 100)}, {}, {}};
  round.failures = {{"asymmetry", "it diverges"}};
  round.moves = {fit_of("gravity", 105)};
  state.so_far.rounds = {round};
  state.refits[0] = fit_of("uptake", 99);
  state.refits[2] = fit_of("gravity", std::numeric_limits<double>::infinity());
  state.refits[2].failure = "a step fails";

  const input::Json json = explain::search_json(state);
  const selection::SearchState read = explain::search_from(input::Json::parse(json.dump()), base);
  EXPECT_EQ(explain::search_json(read).dump(), json.dump());
  EXPECT_EQ(read.next, selection::SearchStep::replace);
  EXPECT_TRUE(read.weighed);
  EXPECT_TRUE(read.so_far.noise_model == state.so_far.noise_model);
  EXPECT_TRUE(read.maps_at == state.maps_at);
  EXPECT_FALSE(read.maps_at == read.fields_at);
  EXPECT_EQ(selection::class_of(read.so_far), (std::vector<std::string>{"uptake", "gravity"}));
  ASSERT_EQ(read.so_far.changes.size(), 2u);
  EXPECT_EQ(read.so_far.changes[1].reason, selection::ModelChange::is_none);
  EXPECT_EQ(read.so_far.changes[0].to, "uptake");
  EXPECT_EQ(read.so_far.excluded.at(0).less, 12);
  const selection::Round& same = read.so_far.rounds.at(0);
  EXPECT_EQ(same.known.diffusion_ratio, 1.5);
  EXPECT_EQ(same.failures.at(0).why, "it diverges");
  EXPECT_EQ(same.moves.at(0).deviance, 105);
  ASSERT_EQ(read.refits.size(), 2u);
  EXPECT_EQ(read.refits.at(0).hypothesis.parts[0].coefficients[0], 0.25);
  EXPECT_EQ(read.refits.at(2).deviance, std::numeric_limits<double>::infinity());
  EXPECT_EQ(read.refits.at(2).failure, "a step fails");
}

TEST(SearchJson, RefusesADiffusionRatioThatIsNone) {
  selection::SearchState state;
  state.so_far.found = fit_of("uptake", 100);
  const input::Json json = explain::search_json(state);
  for (const input::Json& ratio : {input::Json(), input::Json(0), input::Json(-1.5)}) {
    input::Json changed = json;
    changed["so_far"]["found"]["diffusion_ratio"] = ratio;
    EXPECT_ANY_THROW((void)explain::search_from(changed, {})) << ratio;
  }
  EXPECT_NO_THROW((void)explain::search_from(json, {}));
}

// Effects have the model's own parameters, which are not those that are looked for.
TEST(SearchJson, KeepsEffectsOfTheModel) {
  const effects::EffectTerm own{"ohta-kawasaki", {12.5, 0.3}};
  selection::SearchState state;
  state.so_far.found = fit_of("uptake", 100);
  std::vector<assimilation::Hypothesis::Part>& parts = state.so_far.found.hypothesis.parts;
  parts.insert(parts.begin(), assimilation::part_of(own));
  state.so_far.found.hypothesis.known = 1;
  const input::Json json = explain::search_json(state);
  const assimilation::Hypothesis read =
      explain::search_from(input::Json::parse(json.dump()), {}).so_far.found.hypothesis;
  EXPECT_EQ(read.name(), "uptake");
  ASSERT_EQ(read.terms().size(), 2u);
  EXPECT_EQ(read.terms()[0].values, own.values);
  EXPECT_NE(assimilation::find_candidate("ohta-kawasaki")->term({12.5}).values, own.values);
}

// Flow is two candidates, of which a strength of 0 tells nothing.
TEST(SearchJson, KeepsWhichOfTheTwoFlowsItIs) {
  for (const double strength : {0.0, 0.3})
    for (const std::string name : {"flow", "brownian-flow"}) {
      selection::SearchState state;
      state.so_far.found = fit_of(name, 100);
      state.so_far.found.hypothesis.parts[0].coefficients[0] = strength;
      const assimilation::Hypothesis read =
          explain::search_from(explain::search_json(state), {}).so_far.found.hypothesis;
      EXPECT_EQ(read.name(), name);
      EXPECT_EQ(read.is_random(), name == "brownian-flow" && strength > 0);
      EXPECT_EQ(read.terms()[0].values, state.so_far.found.hypothesis.terms()[0].values);
    }
}

// A state that no search writes is damage, never a crash.
TEST(SearchJson, RefusesWhatDoesNotFit) {
  selection::SearchState state;
  state.so_far.found = fit_of("uptake", 100);
  state.so_far.changes = {{selection::ModelChange::left_gap, "exchange", "uptake"}};
  assimilation::Disagreement d{};
  d.direction = Point(1, 0, 0);
  state.so_far.disagreements = {d};
  const input::Json good = explain::search_json(state);
  EXPECT_NO_THROW((void)explain::search_from(good, {}));
  const auto refused = [&](const char* pointer, const input::Json& value) {
    input::Json bad = good;
    bad[input::Json::json_pointer(pointer)] = value;
    EXPECT_THROW((void)explain::search_from(bad, {}), DamagedFile) << pointer << " " << value;
  };
  refused("/so_far/found/covariance", {{"rows", 2}, {"values", {1.0, 0.0}}});
  refused("/so_far/found/hypothesis/parts/0/effect", "../../victim");
  refused("/so_far/found/hypothesis/parts/0/values", input::Json::array());
  refused("/so_far/found/hypothesis/parts/0/coefficients", {1.0, 2.0});
  refused("/so_far/found/hypothesis/known", 7);
  refused("/next", "x");
  refused("/so_far/finding", "x");
  refused("/so_far/changes/0/reason", "99");
  refused("/so_far/disagreements/0/direction", {1.0});
}

}  // namespace
}  // namespace traceraft
