// A search as its file keeps it.
#include "drivers/explain/search_json.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "verification/bench/bench.hpp"

namespace traceraft {
namespace {

Refit fit_of(const std::string& effect, double deviance) {
  Refit fit;
  fit.hypothesis.parts = {{find_candidate(effect).value(), {0.25}}};
  fit.deviance = deviance;
  fit.covariance = Eigen::MatrixXd::Identity(1, 1);
  return fit;
}

TEST(SearchJson, KeepsWhatARoundThatIsNotOverHas) {
  const CahnHilliardModel base = bench_model("degenerate", 0.2);
  SearchState state;
  state.next = SearchStep::replace;
  state.so_far.noise_model = {{{0.1, 0.2}}, {0.3}, {{{0.2, 0.3}, {0.4, 0.1}}, true, 0.07}};
  state.maps_at = {state.so_far.noise_model, 1.25, fit_of("uptake", 0).hypothesis};
  state.weighed = true;
  state.so_far.finding = Finding::ambiguous;
  state.so_far.found = fit_of("uptake", 100);
  state.so_far.rivals = {fit_of("gravity", 101)};
  state.so_far.excluded = {{"exchange", 12}};
  state.so_far.changes = {{ModelChange::left_gap, "exchange", "uptake"},
                          {ModelChange::is_none, "gravity", ""}};
  Round round{{base, 1.5, {}, {}}, {}, fit_of("gravity", 120), {fit_of("uptake", 100)}, {}, {}};
  round.failures = {{"asymmetry", "it diverges"}};
  round.moves = {fit_of("gravity", 105)};
  state.so_far.rounds = {round};
  state.refits[0] = fit_of("uptake", 99);
  state.refits[2] = fit_of("gravity", std::numeric_limits<double>::infinity());
  state.refits[2].failure = "a step fails";

  const Json json = search_json(state);
  const SearchState read = search_from(Json::parse(json.dump()), base);
  EXPECT_EQ(search_json(read).dump(), json.dump());
  EXPECT_EQ(read.next, SearchStep::replace);
  EXPECT_TRUE(read.weighed);
  EXPECT_TRUE(read.so_far.noise_model == state.so_far.noise_model);
  EXPECT_TRUE(read.maps_at == state.maps_at);
  EXPECT_FALSE(read.maps_at == read.fields_at);
  EXPECT_EQ(class_of(read.so_far), (std::vector<std::string>{"uptake", "gravity"}));
  ASSERT_EQ(read.so_far.changes.size(), 2u);
  EXPECT_EQ(read.so_far.changes[1].reason, ModelChange::is_none);
  EXPECT_EQ(read.so_far.changes[0].to, "uptake");
  EXPECT_EQ(read.so_far.excluded.at(0).less, 12);
  const Round& same = read.so_far.rounds.at(0);
  EXPECT_EQ(same.known.pace, 1.5);
  EXPECT_EQ(same.failures.at(0).why, "it diverges");
  EXPECT_EQ(same.moves.at(0).deviance, 105);
  ASSERT_EQ(read.refits.size(), 2u);
  EXPECT_EQ(read.refits.at(0).hypothesis.parts[0].coefficients[0], 0.25);
  EXPECT_EQ(read.refits.at(2).deviance, std::numeric_limits<double>::infinity());
  EXPECT_EQ(read.refits.at(2).failure, "a step fails");
}

// With the parameters that the model has of it, which are not those that are looked for.
TEST(SearchJson, KeepsEffectsOfTheModel) {
  const EffectTerm own{"ohta-kawasaki", {12.5, 0.3}};
  SearchState state;
  state.so_far.found = fit_of("uptake", 100);
  std::vector<Hypothesis::Part>& parts = state.so_far.found.hypothesis.parts;
  parts.insert(parts.begin(), part_of(own));
  state.so_far.found.hypothesis.known = 1;
  const Json json = search_json(state);
  const Hypothesis read = search_from(Json::parse(json.dump()), {}).so_far.found.hypothesis;
  EXPECT_EQ(read.name(), "uptake");
  ASSERT_EQ(read.terms().size(), 2u);
  EXPECT_EQ(read.terms()[0].values, own.values);
  EXPECT_NE(find_candidate("ohta-kawasaki")->term({12.5}).values, own.values);
}

// A state that no search writes is damage, never a crash.
TEST(SearchJson, RefusesWhatDoesNotFit) {
  SearchState state;
  state.so_far.found = fit_of("uptake", 100);
  state.so_far.changes = {{ModelChange::left_gap, "exchange", "uptake"}};
  Disagreement d{};
  d.direction = Point(1, 0, 0);
  state.so_far.disagreements = {d};
  const Json good = search_json(state);
  EXPECT_NO_THROW((void)search_from(good, {}));
  const auto refused = [&](const char* pointer, const Json& value) {
    Json bad = good;
    bad[Json::json_pointer(pointer)] = value;
    EXPECT_THROW((void)search_from(bad, {}), DamagedFile) << pointer << " " << value;
  };
  refused("/so_far/found/covariance", {{"rows", 2}, {"values", {1.0, 0.0}}});
  refused("/so_far/found/hypothesis/parts/0/effect", "../../victim");
  refused("/so_far/found/hypothesis/parts/0/values", Json::array());
  refused("/so_far/found/hypothesis/parts/0/coefficients", {1.0, 2.0});
  refused("/so_far/found/hypothesis/known", 7);
  refused("/next", "x");
  refused("/so_far/finding", "x");
  refused("/so_far/changes/0/reason", "99");
  refused("/so_far/disagreements/0/direction", {1.0});
}

}  // namespace
}  // namespace traceraft
