// What refits say in the units of their user.
#include "drivers/explain/found_parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/explain/remarks.hpp"
#include "drivers/explain/verdict.hpp"
#include "verification/explain/candidates.hpp"

namespace traceraft {
namespace {

// R = 5 µm and D = 1e-5 cm²/s, R²/D is 0.025 s.
const Units kCell{5, 1e-5};

Refit exchange(double a0, double a1) {
  Refit fit;
  fit.hypothesis.parts = {{find_candidate("exchange").value(), {a0, a1}}};
  fit.covariance = Vec(Eigen::Vector2d(9e-4, 1e-6)).asDiagonal();
  return fit;
}

TEST(FoundParameters, ErrorsAreThoseOfWhatTheyAreMadeOf) {
  const auto found = found_parameters(exchange(0.03, 0.01), kCell);
  EXPECT_NEAR(found[0].value, 0.04 / 0.025, 1e-9);
  EXPECT_NEAR(found[0].sigma.value(), std::sqrt(9e-4 + 1e-6) / 0.025, 1e-4);
  // c* = a1 / (a0 + a1).
  EXPECT_NEAR(found[1].value, 0.25, 1e-12);
  EXPECT_NEAR(found[1].sigma.value(), std::hypot(0.01 * 0.03, 0.03 * 0.001) / 0.0016, 1e-3);
}

// With one coefficient held at zero, the exchange is an uptake, and as certain.
TEST(FoundParameters, WhatIsHeldDoesNotBlurTheRate) {
  const auto found = found_parameters(exchange(0, 0.01), kCell);
  EXPECT_NEAR(found[0].sigma.value(), 1e-3 / 0.025, 1e-4);
  EXPECT_EQ(found[1].value, 1);
  EXPECT_GT(found[1].sigma.value(), 1);  // of a target nothing is known
}

// Minutes that are said to be seconds look like a D that is 60 times smaller.
TEST(Remarks, AskWhetherTheUnitOfTimeIsRight) {
  Explanation found;
  found.rounds.resize(1);
  found.false_alarms = 0.02;
  found.found.pace_deviation = 0.1;
  for (const double pace : {1.0 / 9, 1.0, 9.0}) {
    found.found.pace = pace;
    EXPECT_TRUE(remarks(found, kCell).empty()) << pace;
  }
  found.found.pace = 1.0 / 60;
  ASSERT_EQ(remarks(found, kCell).size(), 1u);
  const std::string text = remarks(found, kCell).front();
  EXPECT_NE(text.find("60 times smaller"), std::string::npos) << text;
  EXPECT_NE(text.find("time_unit"), std::string::npos) << text;
  found.found.pace_deviation = 2;  // nothing is known of D
  EXPECT_TRUE(remarks(found, kCell).empty());
}

TEST(Remarks, DoubtADThatMeasurementsContradict) {
  Explanation found;
  found.rounds.resize(1);
  found.found.pace = 1.3;
  EXPECT_TRUE(remarks(found, kCell).empty());  // nothing else is known of it
  found.pace_doubt = 0.1;
  EXPECT_TRUE(remarks(found, kCell).empty());
  found.pace_doubt = 0.05;
  ASSERT_EQ(remarks(found, kCell).size(), 1u);
  const std::string text = remarks(found, kCell).front();
  const std::string expected =
      "to 5 %: together they make it 1.3e-05 cm^2/s, and the model's is 1e-05";
  EXPECT_NE(text.find(expected), std::string::npos) << text;
  // As sure as D was known before, the measurements have told nothing.
  found.found.pace_deviation = 0.05;
  EXPECT_TRUE(remarks(found, kCell).empty());
}

TEST(Remarks, SayWhetherAMeasuredDWouldDecide) {
  Explanation found;
  found.rounds.resize(1);
  found.finding = Finding::ambiguous;
  found.found = exchange(0.03, 0.01);
  found.found.pace = 1.2;
  found.found.pace_deviation = 0.05;
  found.rivals = {found.found, found.found};
  EXPECT_TRUE(remarks(found, kCell).empty());
  found.rivals[1].pace = 2;
  ASSERT_EQ(remarks(found, kCell).size(), 1u);
  const std::string text = remarks(found, kCell).front();
  EXPECT_NE(text.find("exchange for 1.2e-05 cm^2/s, exchange for 1.2e-05, exchange for 2e-05"),
            std::string::npos)
      << text;
}

// A sign is not a matter of words alone.
TEST(Verdict, SaysWhatAnEffectOfThisSignDoes) {
  Explanation found;
  found.finding = Finding::named;
  found.found.hypothesis.parts = {{find_candidate("gravity").value(), {0.01}}};
  EXPECT_NE(verdict_sentence(found).find("rafts that sink"), std::string::npos);
  found.found.hypothesis.parts[0].coefficients[0] = -0.01;
  EXPECT_NE(verdict_sentence(found).find("rafts that rise"), std::string::npos);
}

}  // namespace
}  // namespace traceraft
