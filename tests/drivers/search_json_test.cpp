// A search as its file keeps it.
#include "drivers/explain/search_json.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "verification/measure/bench.hpp"

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
  state.noise = {{0.1, 0.2}};
  state.correlation = {{{0.2, 0.3}, {0.4, 0.1}}, true, 0.07};
  state.told_apart = true;
  state.so_far.finding = Finding::ambiguous;
  state.so_far.found = fit_of("uptake", 100);
  state.so_far.rivals = {fit_of("gravity", 101)};
  state.so_far.told_apart = {{"exchange", 12}};
  state.so_far.turns = {{Turn::left_gap, "exchange", "uptake"}, {Turn::is_none, "gravity", ""}};
  Round round{{base, 1.5, {}, {}}, {}, fit_of("gravity", 120), {fit_of("uptake", 100)}, {}, {}};
  round.failures = {{"asymmetry", "it diverges"}};
  round.moves = {fit_of("gravity", 105)};
  state.so_far.rounds = {round};
  state.ahead[0] = fit_of("uptake", 99);
  state.ahead[2] = fit_of("gravity", std::numeric_limits<double>::infinity());
  state.ahead[2].failure = "a step fails";

  const Json json = search_json(state);
  const SearchState read = search_from(Json::parse(json.dump()), base);
  EXPECT_EQ(search_json(read).dump(), json.dump());
  EXPECT_TRUE(read.told_apart);
  EXPECT_EQ(read.correlation.share(), 0.4);
  EXPECT_EQ(read.correlation.support(), 0.4);
  EXPECT_TRUE(read.correlation.at_bound);
  EXPECT_EQ(read.correlation.error, 0.07);
  EXPECT_EQ(class_of(read.so_far), (std::vector<std::string>{"uptake", "gravity"}));
  ASSERT_EQ(read.so_far.turns.size(), 2u);
  EXPECT_EQ(read.so_far.turns[1].why, Turn::is_none);
  EXPECT_EQ(read.so_far.turns[0].to, "uptake");
  EXPECT_EQ(read.so_far.told_apart.at(0).less, 12);
  const Round& same = read.so_far.rounds.at(0);
  EXPECT_EQ(same.known.pace, 1.5);
  EXPECT_EQ(same.failures.at(0).why, "it diverges");
  EXPECT_EQ(same.moves.at(0).deviance, 105);
  ASSERT_EQ(read.ahead.size(), 2u);
  EXPECT_EQ(read.ahead.at(0).hypothesis.parts[0].coefficients[0], 0.25);
  EXPECT_EQ(read.ahead.at(2).deviance, std::numeric_limits<double>::infinity());
  EXPECT_EQ(read.ahead.at(2).failure, "a step fails");
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
  state.so_far.turns = {{Turn::left_gap, "exchange", "uptake"}};
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
  refused("/found/covariance", {{"rows", 2}, {"values", {1.0, 0.0}}});
  refused("/found/hypothesis/parts/0/effect", "../../victim");
  refused("/found/hypothesis/parts/0/values", Json::array());
  refused("/found/hypothesis/parts/0/coefficients", {1.0, 2.0});
  refused("/found/hypothesis/known", 7);
  refused("/finding", "x");
  refused("/turns/0/why", "99");
  refused("/disagreements/0/direction", {1.0});
}

}  // namespace
}  // namespace traceraft
