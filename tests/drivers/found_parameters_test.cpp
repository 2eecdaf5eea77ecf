// The words of refits, in the units of their user.
#include "drivers/explain/found_parameters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drivers/explain/remarks.hpp"
#include "drivers/explain/verdict.hpp"
#include "drivers/explain/verdict_sentence.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"
#include "verification/assimilation/forecast/candidates.hpp"

namespace traceraft {
namespace {

// R = 5 µm and D = 1e-5 cm²/s, R²/D is 0.025 s.
const physics::Units kCell{5, 1e-5};

selection::Refit exchange(double a0, double a1) {
  selection::Refit fit;
  fit.hypothesis.parts = {{assimilation::find_candidate("exchange").value(), {a0, a1}}};
  fit.covariance = Vec(Eigen::Vector2d(9e-4, 1e-6)).asDiagonal();
  return fit;
}

TEST(FoundParameters, ErrorsAreThoseOfWhatTheyAreMadeOf) {
  const auto found = explain::found_parameters(exchange(0.03, 0.01), kCell);
  EXPECT_NEAR(found[0].value, 0.04 / 0.025, 1e-9);
  EXPECT_NEAR(found[0].sigma.value(), std::sqrt(9e-4 + 1e-6) / 0.025, 1e-4);
  // c* = a1 / (a0 + a1).
  EXPECT_NEAR(found[1].value, 0.25, 1e-12);
  EXPECT_NEAR(found[1].sigma.value(), std::hypot(0.01 * 0.03, 0.03 * 0.001) / 0.0016, 1e-3);
}

// An exchange with one coefficient held at zero is an uptake, and as certain.
TEST(FoundParameters, WhatIsHeldDoesNotBlurTheRate) {
  const auto found = explain::found_parameters(exchange(0, 0.01), kCell);
  EXPECT_NEAR(found[0].sigma.value(), 1e-3 / 0.025, 1e-4);
  EXPECT_EQ(found[1].value, 1);
  EXPECT_GT(found[1].sigma.value(), 1);  // of a target nothing is known
}

// The strength is the second parameter of flow, and others that do not count are not told.
TEST(FoundParameters, BrownianFlowIsToldByItsOwnStrength) {
  selection::Explanation found;
  selection::Refit& fit = found.found;
  fit.hypothesis.parts = {{assimilation::find_candidate("brownian-flow").value(), {0.001}}};
  fit.covariance = Vec::Constant(1, 4e-8).asDiagonal();
  fit.diffusion_ratio = 2;
  const auto parameters = explain::found_parameters(fit, kCell);
  ASSERT_EQ(parameters.size(), 3U);  // with D, without the seed
  EXPECT_EQ(parameters[0].effect + "." + parameters[0].name, "brownian-flow.thermal");
  EXPECT_EQ(parameters[0].value, 0.001);
  EXPECT_NEAR(parameters[0].sigma.value(), 2e-4, 1e-9);
  EXPECT_EQ(parameters[1].name, "water");
  const auto model = explain::found_model(found, {});
  EXPECT_EQ(model.at("effect").text, "flow:thermal=0.001,water=1.25,seed=1");
}

// D = 1e-5 cm²/s and R = 5 µm: Θ = 1e-3 is k_B T/(4.1 nPa s m D), and W nearly that of such a
// membrane.
TEST(FoundParameters, BrownianFlowIsThatOfAViscosity) {
  selection::Explanation found;
  found.finding = selection::Finding::named;
  found.found.hypothesis.parts = {{assimilation::find_candidate("brownian-flow").value(), {0.001}}};
  found.found.covariance = Vec::Constant(1, 4e-8).asDiagonal();
  found.found.expected = {0.05, 0};
  found.found.random = {0.03, 0};
  found.rounds.resize(1);
  const auto said = [&] { return joined(explain::remarks(found, kCell), "\n"); };
  EXPECT_NE(said().find("0.05 with this motion, 0.04 without"), std::string::npos) << said();
  EXPECT_NE(said().find("4.2 nPa s m (2.2 to 8.9)"), std::string::npos) << said();
  EXPECT_EQ(said().find("further between snapshots"), std::string::npos) << said();
  found.found.random.train = 0.045;
  EXPECT_NE(said().find("further between snapshots"), std::string::npos) << said();
  found.found.hypothesis.parts[0].coefficients = {1};
  EXPECT_NE(said().find("faster than the water"), std::string::npos) << said();
}

// No forecast closes what moves at random: that part of a gap is explained.
TEST(FoundParameters, SharesClosedLeaveOutWhatIsRandom) {
  selection::Refit base, fit;
  base.gap = fit.gap = fit.expected = {5, 0};
  fit.random = {4, 0};
  EXPECT_NEAR(selection::shares_closed(base, fit).train.value(), 1, 1e-14);
  fit.gap = {std::sqrt(25 + 8.0), 0};
  EXPECT_NEAR(selection::shares_closed(base, fit).train.value(), 0.5, 1e-14);
  // A base that has the motion already lacks nothing.
  base.random = fit.random;
  fit.gap = {5, 0};
  EXPECT_FALSE(selection::shares_closed(base, fit).train);
}

// D makes up for part of what is missing without a name.
TEST(FoundParameters, KnowNoDiffusionWhereSomethingIsMissing) {
  selection::Explanation found;
  found.found.diffusion_ratio = 2;
  found.found.diffusion_ratio_deviation = 0.1;
  for (const selection::Finding finding :
       {selection::Finding::unnamed, selection::Finding::not_identifiable,
        selection::Finding::below_resolution}) {
    found.finding = finding;
    EXPECT_FALSE(explain::told_parameters(found, found.found, kCell).back().sigma);
    EXPECT_FALSE(explain::diffusion_range(found, kCell));
  }
  found.finding = selection::Finding::none;
  EXPECT_NEAR(explain::told_parameters(found, found.found, kCell).back().sigma.value(), 2e-6,
              1e-12);
}

TEST(FoundParameters, WidenDiffusionByWhatItMakesUpFor) {
  selection::Explanation found;
  found.finding = selection::Finding::none;
  found.found.diffusion_ratio = 2;
  found.found.diffusion_ratio_deviation = 0.1;
  found.rounds.resize(1);
  EXPECT_FALSE(explain::diffusion_range(found, kCell));
  found.rounds[0].screening.confounded = {{"bulk-mobility", 7, 0.95}};
  const double width = std::exp(1.96 * 0.1),
               most = assimilation::find_candidate("bulk-mobility")->most;
  const auto range = explain::diffusion_range(found, kCell);
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->high, 2e-5 * width, 1e-9);
  EXPECT_NEAR(range->low, 2e-5 / width / (1 + 7 * most), 1e-9);
  EXPECT_NE(range->why.find("D (1 + 7 s)"), std::string::npos) << range->why;
  found.diffusion_ratio_doubt = 0.05;  // D was measured
  EXPECT_FALSE(explain::diffusion_range(found, kCell));
}

TEST(FoundParameters, WidenDiffusionByTheClass) {
  selection::Explanation found;
  found.finding = selection::Finding::ambiguous;
  found.found.diffusion_ratio = 1;
  found.found.diffusion_ratio_deviation = 0.01;
  found.rivals.resize(1);
  found.rivals[0].diffusion_ratio = 3;
  found.rivals[0].diffusion_ratio_deviation = 0.1;
  const auto range = explain::diffusion_range(found, kCell);
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->low, 1e-5 / std::exp(1.96 * 0.01), 1e-9);
  EXPECT_NEAR(range->high, 3e-5 * std::exp(1.96 * 0.1), 1e-9);
}

// Minutes that are said to be seconds look like a D that is 60 times smaller.
TEST(Remarks, AskWhetherTheUnitOfTimeIsRight) {
  selection::Explanation found;
  found.rounds.resize(1);
  found.finding = selection::Finding::named;
  found.false_alarms = 0.02;
  found.found.diffusion_ratio_deviation = 0.1;
  for (const double diffusion_ratio : {1.0 / 9, 1.0, 9.0}) {
    found.found.diffusion_ratio = diffusion_ratio;
    EXPECT_TRUE(explain::remarks(found, kCell).empty()) << diffusion_ratio;
  }
  found.found.diffusion_ratio = 1.0 / 60;
  ASSERT_EQ(explain::remarks(found, kCell).size(), 1u);
  const std::string text = explain::remarks(found, kCell).front();
  EXPECT_NE(text.find("60 times smaller"), std::string::npos) << text;
  EXPECT_NE(text.find("time_unit"), std::string::npos) << text;
  found.found.diffusion_ratio_deviation = 2;  // nothing is known of D
  EXPECT_TRUE(explain::remarks(found, kCell).empty());
}

TEST(Remarks, DoubtADThatMeasurementsContradict) {
  selection::Explanation found;
  found.rounds.resize(1);
  found.finding = selection::Finding::named;
  found.found.diffusion_ratio = 1.3;
  EXPECT_TRUE(explain::remarks(found, kCell).empty());  // nothing else is known of it
  found.diffusion_ratio_doubt = 0.1;
  EXPECT_TRUE(explain::remarks(found, kCell).empty());
  found.diffusion_ratio_doubt = 0.05;
  ASSERT_EQ(explain::remarks(found, kCell).size(), 1u);
  const std::string text = explain::remarks(found, kCell).front();
  const std::string expected =
      "D, 1e-05 cm^2/s, which is said to be known to 5 %. The value from both is 1.3e-05";
  EXPECT_NE(text.find(expected), std::string::npos) << text;
  // The measurements have told nothing if D is as sure as it was known before.
  found.found.diffusion_ratio_deviation = 0.05;
  EXPECT_TRUE(explain::remarks(found, kCell).empty());
}

TEST(Remarks, SayWhetherAMeasuredDWouldDecide) {
  selection::Explanation found;
  found.rounds.resize(1);
  found.finding = selection::Finding::ambiguous;
  found.found = exchange(0.03, 0.01);
  found.found.diffusion_ratio = 1.2;
  found.found.diffusion_ratio_deviation = 0.05;
  found.rivals = {found.found, found.found};
  EXPECT_TRUE(explain::remarks(found, kCell).empty());
  found.rivals[1].diffusion_ratio = 2;
  ASSERT_EQ(explain::remarks(found, kCell).size(), 1u);
  const std::string text = explain::remarks(found, kCell).front();
  EXPECT_NE(text.find("exchange for 1.2e-05 cm^2/s, exchange for 1.2e-05, exchange for 2e-05"),
            std::string::npos)
      << text;
}

// Where nothing is found, D may stand for something.
TEST(Remarks, SayWhatAnotherDMayHide) {
  selection::Explanation found;
  found.rounds.resize(1);
  found.found.diffusion_ratio = 1.2;
  found.found.diffusion_ratio_deviation = 0.01;
  ASSERT_EQ(explain::remarks(found, kCell).size(), 1u);
  EXPECT_NE(explain::remarks(found, kCell).front().find("bulk-mobility"), std::string::npos);
  EXPECT_NE(explain::verdict_sentence(found).find("with 1.2 times its D"), std::string::npos);
  found.found.diffusion_ratio_deviation = 0.1;  // or the same D
  EXPECT_TRUE(explain::remarks(found, kCell).empty());
  EXPECT_EQ(explain::verdict_sentence(found).find("its D"), std::string::npos);
}

selection::Refit of_strength(const std::string& effect, double strength) {
  selection::Refit fit;
  fit.hypothesis.parts = {{assimilation::find_candidate(effect).value(), {strength}}};
  fit.covariance = Eigen::MatrixXd::Identity(1, 1);
  return fit;
}

// An effect that the model states is held against these data; one that is none is not written.
TEST(OwnEffects, AreHeldAgainstTheData) {
  explain::ExplainSetup setup;
  const effects::EffectTerm gravity{"gravity", {0.3}};
  setup.request.own = assimilation::of_model({gravity});
  selection::Explanation found;
  found.rounds.resize(1);
  found.rounds[0].known.hypothesis = setup.request.own;
  for (const double strength : {0.29, 0.2, 0.0}) {
    found.base = of_strength("gravity", strength);
    found.base.hypothesis.known = 1;
    found.base.covariance *= 4e-4;
    found.found = found.base;
    const std::vector<std::string> all = explain::remarks_on(found, setup);
    const std::string contradiction = formatted(
        "with strength = 0.3. These data contradict it: the fit is %.4g (standard error 0.02).",
        strength);
    ASSERT_EQ(all.size(), strength == 0.29 ? 0u : strength == 0 ? 2u : 1u) << strength;
    if (!all.empty()) {
      EXPECT_NE(all[0].find(contradiction), std::string::npos) << all[0];
    }
    if (strength == 0) {
      EXPECT_EQ(all[1], "These data show nothing of the model's gravity.");
    }
    EXPECT_EQ(explain::found_model(found, {}).count("effect"), strength == 0 ? 0u : 1u);
    EXPECT_NE(explain::verdict_sentence(found).find("with the fitted strengths of its effects"),
              std::string::npos);
  }
}

// Nothing was fitted: no strength of the model is doubted, and earlier times are asked for.
TEST(OwnEffects, AreLeftAloneWhereRaftsAreAtRest) {
  explain::ExplainSetup setup;
  setup.request.own = assimilation::of_model({{"gravity", {0.3}}});
  assimilation::FieldSeries vesicle;
  vesicle.snapshots.resize(2);
  vesicle.snapshots[0].time = 50;
  setup.series = {vesicle};
  selection::Explanation found;
  found.at_rest = true;
  found.finding = selection::Finding::not_identifiable;
  found.found.hypothesis = setup.request.own;
  found.found.settled = true;
  found.base = found.found;
  found.rounds.resize(1);
  found.rounds[0].known.hypothesis = setup.request.own;
  const std::vector<std::string> all = explain::remarks_on(found, setup);
  ASSERT_EQ(all.size(), 1u) << all.front();
  const double seconds = 50 * setup.configuration.units().seconds_per_unit();
  EXPECT_NE(all[0].find(formatted("%.4g s", seconds)), std::string::npos) << all[0];
  const explain::Verdict verdict = explain::verdict_of(found, setup);
  EXPECT_TRUE(verdict.parameters.empty());
  EXPECT_FALSE(verdict.p);
  EXPECT_TRUE(explain::verdict_json(verdict).at("null").at("p").is_null());
}

TEST(OwnEffects, AreNotLookedForInAnotherForm) {
  const auto beside = [](const effects::EffectTerm& term) {
    std::vector<std::string> names;
    for (const assimilation::Candidate& candidate : assimilation::candidates_beside(
             assimilation::of_model({term}), assimilation::candidates()))
      names.push_back(candidate.name);
    return names;
  };
  const auto has = [](const std::vector<std::string>& names, const char* name) {
    return std::count(names.begin(), names.end(), name) > 0;
  };
  const auto uptake = beside({"uptake", {0.2}}), exchange = beside({"exchange", {0.2, 0.4}}),
             gravity = beside({"gravity", {0.1}});
  EXPECT_TRUE(!has(uptake, "uptake") && !has(uptake, "exchange") && has(uptake, "gravity"));
  EXPECT_TRUE(!has(exchange, "uptake") && !has(exchange, "exchange"));
  EXPECT_TRUE(!has(gravity, "gravity") && has(gravity, "uptake") && has(gravity, "exchange"));
  EXPECT_EQ(gravity.size() + 1, assimilation::candidates().size());
}

TEST(OwnEffects, KeepTheirParameters) {
  const effects::EffectTerm exchange{"exchange", {0.2, 0.4}};
  const assimilation::Hypothesis::Part part = assimilation::part_of(exchange);
  const effects::EffectTerm same = part.candidate.term(part.coefficients);
  EXPECT_NEAR(same.values[0], 0.2, 1e-15);
  EXPECT_NEAR(same.values[1], 0.4, 1e-15);
  EXPECT_THROW(assimilation::part_of({"rotation", {1, 0, 0, 1}}), InputError);
}

TEST(Remarks, TellWhatTheSearchThoughtOfBefore) {
  selection::Explanation found;
  found.finding = selection::Finding::named;
  found.found = of_strength("gravity", 0.01);
  found.rounds.resize(1);
  EXPECT_TRUE(explain::remarks(found, kCell).empty());
  found.changes = {{selection::ModelChange::replaced, "uptake", "cooling"},
                   {selection::ModelChange::left_gap, "cooling", "exchange"},
                   {selection::ModelChange::foretold, "exchange", "gravity + uptake"},
                   {selection::ModelChange::is_none, "uptake", "gravity"}};
  const std::vector<std::string> expected{
      "uptake explained most at first, but cooling explains more.",
      "cooling explained most at first, but leaves a gap that exchange does not leave.",
      "exchange explained most at first, but with the held-out snapshots gravity + uptake is more "
      "probable.",
      "uptake was found at first, but beside gravity it is not significant."};
  EXPECT_EQ(explain::remarks(found, kCell), expected);
  // Once is enough.
  found.changes = {{selection::ModelChange::foretold, "uptake", "gravity"}};
  found.excluded = {{"uptake", 129}};
  ASSERT_EQ(explain::remarks(found, kCell).size(), 1u);
  EXPECT_NE(explain::remarks(found, kCell)
                .front()
                .find("the held-out snapshot (difference of Schwarz' criterion: -129)"),
            std::string::npos);
}

TEST(Remarks, SayThatAStrengthIsAtItsEnd) {
  selection::Explanation found;
  found.rounds.resize(1);
  found.finding = selection::Finding::named;
  const assimilation::Candidate contrast =
      assimilation::find_candidate("mobility-contrast").value();
  found.found = of_strength("mobility-contrast", contrast.most);
  ASSERT_EQ(explain::remarks(found, kCell).size(), 1u);
  EXPECT_NE(explain::remarks(found, kCell).front().find("as strong as the search allows"),
            std::string::npos);
  found.found = of_strength("mobility-contrast", 0.9 * contrast.most);
  EXPECT_TRUE(explain::remarks(found, kCell).empty());
}

// A sign is not a matter of words alone.
TEST(Verdict, SaysWhatAnEffectOfThisSignDoes) {
  selection::Explanation found;
  found.finding = selection::Finding::named;
  found.found.hypothesis.parts = {{assimilation::find_candidate("gravity").value(), {0.01}}};
  EXPECT_NE(explain::verdict_sentence(found).find("rafts sink"), std::string::npos);
  found.found.hypothesis.parts[0].coefficients[0] = -0.01;
  EXPECT_NE(explain::verdict_sentence(found).find("rafts rise"), std::string::npos);
  EXPECT_EQ(explain::verdict_sentence(found).find("The model lacks gravity"), 0u);
  found.rerun = selection::Rerun{};  // which gains nothing
  EXPECT_EQ(explain::verdict_sentence(found).find("The model may lack gravity"), 0u);
}

}  // namespace
}  // namespace traceraft
