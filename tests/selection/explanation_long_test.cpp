// The search where it has to choose between what it found and its rivals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "drivers/explain/search_json.hpp"
#include "tests/support/small_vesicle.hpp"
#include "verification/assimilation/forecast/candidates.hpp"
#include "verification/selection/search/explanation.hpp"
#include "verification/selection/search/rerun.hpp"
#include "verification/selection/search/steps.hpp"

namespace traceraft::selection {
namespace {

// A small vesicle with an uptake, measured with little noise; the last of four looks is held out.
class RivalsTest : public ::testing::Test {
 protected:
  static const std::vector<assimilation::FieldSeries>& measured() {
    static const std::vector<assimilation::FieldSeries> vesicles =
        draw_blind_case(testing::small_vesicle(4)).vesicles;
    return vesicles;
  }

  RivalsTest() {
    request_.base = testing::small_vesicle(4).base;
    request_.surface = geometry::make_surface("sphere");
    request_.cells = 10;
    request_.filter.rank = 30;
    // The first look is right: with three that count uptake would be one with what it might lack.
    request_.filter.first_gain = request_.filter.first_offset = 0;
    request_.filter.replicates = 49;
    request_.most_effects = 1;  // what was found, or its rivals
    request_.confirm = false;
    const std::set<std::string> some{"exchange", "gravity", "line-tension", "uptake"};
    for (const assimilation::Candidate& candidate : assimilation::candidates())
      if (some.count(candidate.name) == 0) request_.without.push_back(candidate.name);
  }

  // Each once.
  Refit fit_of(const std::string& effect) const {
    static std::map<std::string, Refit> known;
    if (const auto before = known.find(effect); before != known.end()) return before->second;
    assimilation::FilterModel model{request_.base, 1, {}, {}};
    model.hypothesis.parts = {{assimilation::find_candidate(effect).value(), {0.0}}};
    const assimilation::FilterProblems data = problems_of(measured(), request_);
    std::vector<assimilation::ErrorMaps> maps;
    (void)assimilation::filter_fields(data, model, request_.filter, maps);
    return known[effect] = refit(data, model, request_.filter, maps);
  }

  // The state as if a first round had found the one and that the others explain the data as well.
  SearchState state_of(const Refit& found, const std::vector<Refit>& rivals) const {
    SearchState state;
    state.next = SearchStep::calibrate;
    state.so_far.found = state.so_far.base = found;
    state.so_far.rivals = rivals;
    state.so_far.finding = rivals.empty() ? Finding::named : Finding::ambiguous;
    state.so_far.noise_model = assimilation::noise_model(problems_of(measured(), request_));
    return state;
  }

  Explanation explained(const Refit& found, const std::vector<Refit>& rivals) const {
    Explanation result = explain_fields(measured(), request_, state_of(found, rivals));
    result.base.hypothesis = {};  // that of a whole search
    return result;
  }

  Explanation explained_by_gravity() const {
    static const Explanation known = explained(fit_of("gravity"), {});
    return known;
  }

  ExplainRequest request_;
};

TEST_F(RivalsTest, AreTakenIfTheyLeaveNoGap) {
  const Explanation alone = explained_by_gravity();
  EXPECT_EQ(alone.finding, Finding::unnamed);
  const Explanation left = explained(fit_of("gravity"), {fit_of("uptake")});
  EXPECT_EQ(left.finding, Finding::named);
  EXPECT_EQ(class_of(left), std::vector<std::string>{"uptake"});
  EXPECT_LT(left.found.gap.heldout, alone.found.gap.heldout);
}

// A gap that nothing explains has to be there on another mesh, too.
TEST_F(RivalsTest, ARunOnAnotherMeshDecidesWhetherAGapIsThere) {
  Explanation right = explained(fit_of("uptake"), {});
  EXPECT_EQ(right.finding, Finding::named);
  right.without_gap = right.finding;
  right.finding = Finding::unnamed;  // as if the mesh had left a gap
  run_again(measured(), request_, right);
  EXPECT_EQ(right.finding, Finding::named);
  EXPECT_GT(right.rerun->gap_p.value(), 0.005);
  EXPECT_TRUE(right.rerun->confirms());

  Explanation wrong = explained_by_gravity();
  EXPECT_EQ(wrong.without_gap, Finding::named);
  run_again(measured(), request_, wrong);
  EXPECT_EQ(wrong.finding, Finding::unnamed);
  EXPECT_LT(wrong.rerun->gap_p.value(), 0.005);
}

// Where nothing was found, too.
TEST_F(RivalsTest, AGapIsLookedForWhereNothingWasFound) {
  Explanation found;
  found.finding = Finding::unnamed;
  found.without_gap = Finding::none;
  found.found.diffusion_ratio = 1;
  found.noise_model = assimilation::noise_model(problems_of(measured(), request_));
  run_again(measured(), request_, found);
  EXPECT_EQ(found.finding, Finding::unnamed);  // of the uptake
  EXPECT_LT(found.rerun->gap_p.value(), 0.005);
  EXPECT_GT(found.rerun->found.heldout, 1.1 * found.rerun->floor.heldout);
}

TEST_F(RivalsTest, AreNotIfTheyLeaveOneToo) {
  const Explanation left = explained(fit_of("gravity"), {fit_of("line-tension")});
  EXPECT_EQ(left.finding, Finding::unnamed);
  EXPECT_EQ(left.found.hypothesis.name(), "gravity");
}

// The error of the mesh is a doubt only where it would explain what is missing.
TEST_F(RivalsTest, AGapIsLookedForBesideWhatTheMeshCouldBe) {
  Search search(measured(), request_);
  SearchState state = state_of({}, {fit_of("line-tension")});
  state.so_far.rounds = {
      Round{{request_.base, 1, {}, {}}, {}, {}, {fit_of("gravity"), fit_of("uptake")}, {}, {}}};
  state.so_far.noise_model.levels[0][1] *= 3;
  const std::vector<Refit>& refits = state.so_far.rounds[0].refits;
  EXPECT_TRUE(leaves_gap(search, state, refits[0]));
  EXPECT_FALSE(leaves_gap(search, state, refits[1]));
  // The noise of the state is there again.
  EXPECT_EQ(search.data(state)[0].noise, state.so_far.noise_model.levels[0]);
}

// An interrupted step knows a refit that the mesh could be: less than it would be told from.
TEST_F(RivalsTest, MoreIsMissingThanWhatTheMeshCouldBe) {
  request_.false_alarms = 1;  // whatever looks best is refitted
  request_.without.insert(request_.without.end(), {"exchange", "line-tension", "uptake"});
  SearchState screened;
  request_.save = [&](const SearchState& state) {
    if (state.next == SearchStep::refit && state.refits.empty()) screened = state;
  };
  const Explanation weak = explain_fields(measured(), request_, state_of({}, {}));
  const Round& round = weak.rounds[0];
  ASSERT_EQ(round.refits.size(), 1u);
  Refit strong = round.refits[0];
  constexpr double kGain = 40;
  strong.deviance = round.without.deviance - kGain;
  strong.hypothesis.parts[0].coefficients = {std::sqrt(kGain * strong.covariance(0, 0))};
  const double values = assimilation::count_values(problems_of(measured(), request_));
  ASSERT_LT(criterion(strong, values), criterion(round.without, values));
  ASSERT_GT(certainty(strong, 0), kTelling);
  ASSERT_FALSE(all_resolved(strong, values, round.screening.mesh_error));
  ASSERT_EQ(screened.next, SearchStep::refit);
  screened.refits[0] = strong;
  const Explanation found = explain_fields(measured(), request_, screened);
  EXPECT_EQ(found.finding, Finding::unnamed);
  EXPECT_EQ(found.without_gap, Finding::below_resolution);
  EXPECT_TRUE(found.found.hypothesis.parts.empty());
}

// Rivals that leave no gap are told apart, too. Equally good ones stay; a better one comes first.
TEST_F(RivalsTest, AreToldApartByAllThatWasMeasured) {
  request_.false_alarms = -1;  // no gap is one
  const Refit right = fit_of("uptake"), wrong = fit_of("gravity");
  EXPECT_EQ(class_of(explained(right, {right})).size(), 2u);
  const Explanation found = explained(right, {wrong});
  EXPECT_EQ(class_of(found), std::vector<std::string>{"uptake"});
  ASSERT_EQ(found.excluded.size(), 1u);
  EXPECT_EQ(found.excluded[0].effect, "gravity");
  const Explanation turned = explained(wrong, {right});
  EXPECT_EQ(turned.finding, Finding::named);
  EXPECT_EQ(class_of(turned), std::vector<std::string>{"uptake"});
  EXPECT_NEAR(turned.excluded.at(0).less, found.excluded[0].less, 2);

  // The criterion of a search that holds out nothing, but with the noise of the found model.
  request_.hold_out = false;
  const auto criterion_of = [&](const Refit& start) {
    const assimilation::FilterProblems data = problems_of(measured(), request_);
    return criterion(refit_of(data, request_.base, start, request_.filter),
                     assimilation::count_values(data));
  };
  const double all = criterion_of(wrong) - criterion_of(right),
               counting = wrong.deviance - right.deviance;
  EXPECT_NEAR(found.excluded[0].less, all, 0.2 * all);
  EXPECT_GT(all, 1.2 * counting);  // a third snapshot more
}

// Gravity seems to be there with the errors of the model before, and is not with its own. The
// uptake shows only in the held-out snapshot.
TEST_F(RivalsTest, EffectsThatTurnOutToBeNoneAreDropped) {
  request_.most_effects = 2;
  Refit both = fit_of("uptake");
  both.hypothesis.parts.push_back({assimilation::find_candidate("gravity").value(), {0.001}});
  SearchState state = state_of(both, {});
  state.so_far.rounds = {Round{{request_.base, 1, {}, {}}, {}, state.so_far.base, {}, {}, {}}};
  const Explanation found = explain_fields(measured(), request_, state);
  EXPECT_EQ(found.finding, Finding::named);
  EXPECT_EQ(class_of(found), std::vector<std::string>{"uptake"});
  ASSERT_EQ(found.changes.size(), 1u);
  EXPECT_EQ(found.changes[0].reason, ModelChange::is_none);
  EXPECT_EQ(found.changes[0].from, "gravity");
  EXPECT_EQ(found.changes[0].to, "uptake");
  // The search goes on beside uptake, and gravity, which was dropped, has bounds.
  EXPECT_EQ(found.rounds.back().known.hypothesis.name(), "uptake");
  const auto is_of_gravity = [](const Bound& bound) { return bound.effect == "gravity"; };
  const std::vector<Bound> bounds = bounds_of(found);
  EXPECT_TRUE(std::any_of(bounds.begin(), bounds.end(), is_of_gravity));

  both.hypothesis.parts.erase(both.hypothesis.parts.begin());
  state.so_far.found = both;
  const Explanation nothing = explain_fields(measured(), request_, state);
  EXPECT_FALSE(is_named(nothing));
  EXPECT_TRUE(nothing.found.hypothesis.parts.empty());
}

// The noise is larger than the errors of this mesh, and no snapshot is held out.
class OwnEffectsTest : public RivalsTest {
 protected:
  OwnEffectsTest() {
    request_.hold_out = false;
    request_.without.push_back("exchange");  // another form of uptake
    asked_.noise = 0.15;
  }
  Explanation explained_with(const effects::EffectTerm& own) {
    request_.own = assimilation::of_model({own});
    return explain_fields(draw_blind_case(asked_).vesicles, request_);
  }
  static double deviation(const Explanation& found) {
    return std::sqrt(found.found.covariance(0, 0));
  }
  BlindRequest asked_ = testing::small_vesicle(4);
};

// The strengths of effects that the model has are fitted as D is; what they cannot do is missing.
TEST_F(OwnEffectsTest, AreFittedAndNotFound) {
  const double truth = draw_blind_case(asked_).truth[0].values[0];
  const Explanation whole = explained_with({"uptake", {-truth}});
  EXPECT_EQ(whole.finding, Finding::none);
  EXPECT_TRUE(class_of(whole).empty());
  ASSERT_EQ(whole.found.hypothesis.parts.size(), 1u);
  const double rate = whole.found.diffusion_ratio * whole.found.hypothesis.parts[0].coefficients[0];
  EXPECT_NEAR(rate, truth, 4 * deviation(whole));
  EXPECT_LT(deviation(whole), 0.15 * std::fabs(truth));

  // One that is none, and would bring the rafts to rest, stays, and is no part of the name.
  const Explanation lacking = explained_with({"gravity", {0.3}});
  EXPECT_EQ(lacking.finding, Finding::named);
  EXPECT_EQ(class_of(lacking), std::vector<std::string>{"uptake"});
  ASSERT_EQ(lacking.found.hypothesis.parts.size(), 2u);
  EXPECT_EQ(lacking.found.hypothesis.parts[0].candidate.name, "gravity");
  EXPECT_NEAR(lacking.found.hypothesis.parts[0].coefficients[0], 0, 4 * deviation(lacking));
  EXPECT_LT(deviation(lacking), 0.001);
  EXPECT_NEAR(lacking.found.gap.train, whole.found.gap.train, 0.02 * whole.found.gap.train);
  EXPECT_GT(lacking.base.gap.train, 1.02 * lacking.found.gap.train);
}

// One so strong that its perturbations cannot be advanced, and of which there is nothing.
TEST_F(OwnEffectsTest, MayBeNone) {
  asked_.effects.clear();
  const effects::EffectTerm strong{"ohta-kawasaki", {0.3, 1}};
  const Explanation found = explained_with(strong);
  EXPECT_EQ(found.finding, Finding::none);
  EXPECT_NEAR(std::log(found.found.diffusion_ratio), 0, 4 * found.found.diffusion_ratio_deviation);
  EXPECT_LT(found.found.hypothesis.parts[0].coefficients[0], 4 * deviation(found));
  EXPECT_LT(deviation(found), 0.05);
}

// The state is all that a search goes on from: a search that is stopped after any step, or after a
// refit, takes the next step to the same state, to the last bit.
TEST_F(OwnEffectsTest, AfterAnyStopTheNextStateIsTheSame) {
  request_.confirm = true;
  // Noise that neighbours share, whose estimate the first field depends on, too.
  asked_.noise_share = 0.5;
  asked_.noise_correlation = 0.1;
  std::vector<SearchState> saved;
  request_.save = [&](const SearchState& state) { saved.push_back(state); };
  const std::vector<assimilation::FieldSeries> vesicles = draw_blind_case(asked_).vesicles;
  ASSERT_TRUE(is_named(explain_fields(vesicles, request_)));
  request_.save = nullptr;
  std::set<SearchStep> steps;
  for (std::size_t k = 0; k + 1 < saved.size(); ++k) {
    // One of the refits of a step stands for all of them.
    if (saved[k].refits.size() > 1) continue;
    steps.insert(saved[k].next);
    Search search(vesicles, request_);
    const SearchState next = next_state(search, saved[k]);
    const auto whole = std::find_if(saved.begin() + static_cast<std::ptrdiff_t>(k) + 1, saved.end(),
                                    [](const SearchState& state) { return state.refits.empty(); });
    EXPECT_EQ(explain::search_json(next).dump(), explain::search_json(*whole).dump())
        << word_for(saved[k].next);
  }
  const std::set<SearchStep> expected{
      SearchStep::calibrate, SearchStep::eliminate, SearchStep::screen, SearchStep::refit,
      SearchStep::choose,    SearchStep::replace,   SearchStep::weigh,  SearchStep::confirm};
  EXPECT_EQ(steps, expected);
}

// An interrupted step goes on from its last refit.
TEST_F(RivalsTest, RefitsOfAnInterruptedStepAreNotDoneAgain) {
  constexpr std::size_t kDone = 2;
  request_.false_alarms = 1;  // whatever looks best is refitted
  const SearchState begin = state_of({}, {});
  std::vector<std::size_t> saved;  // refits that each save has of the step
  request_.save = [&](const SearchState& state) { saved.push_back(state.refits.size()); };
  (void)explain_fields(measured(), request_, begin);
  const std::vector<std::size_t> all = saved;
  ASSERT_GT(*std::max_element(all.begin(), all.end()), kDone);

  SearchState interrupted;
  request_.save = [&](const SearchState& state) {
    if (interrupted.refits.size() < kDone) interrupted = state;  // other threads finish theirs
    if (state.refits.size() >= kDone) throw std::runtime_error("interrupted");
  };
  EXPECT_THROW(explain_fields(measured(), request_, begin), std::runtime_error);
  ASSERT_EQ(interrupted.refits.size(), kDone);

  saved.clear();
  request_.save = [&](const SearchState& state) { saved.push_back(state.refits.size()); };
  (void)explain_fields(measured(), request_, interrupted);
  const auto after = std::find(all.begin(), all.end(), kDone) + 1;
  EXPECT_EQ(saved, std::vector<std::size_t>(after, all.end()));
}

}  // namespace
}  // namespace traceraft::selection
