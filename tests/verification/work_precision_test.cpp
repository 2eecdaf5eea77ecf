#include "verification/bench/work_precision.hpp"

#include <gtest/gtest.h>

#include "verification/statistics/sample.hpp"

namespace traceraft {
namespace {

// CPU times are half as long again as wall times.
bench::WorkPoint point(const char* integrator, double tolerance, double error,
                       std::vector<double> wall) {
  std::vector<double> cpu;
  for (const double seconds : wall) cpu.push_back(1.5 * seconds);
  return {integrator, "block", tolerance, "", error, cpu, wall, {}};
}

TEST(Recommendation, TakesTheCheapestAtTheErrorThatAllReach) {
  const bench::Recommendation advice = bench::recommend(
      {point("euler", 1e-2, 1e-1, {1.0}), point("euler", 1e-3, 1e-2, {9.0, 10.0, 11.0}),
       point("ida", 1e-2, 5e-2, {0.5}), point("ida", 1e-3, 2e-3, {2.0, 2.1, 1.9}),
       point("ida", 1e-4, 1e-4, {4.0})},
      0);
  EXPECT_EQ(advice.target, 1e-2);
  EXPECT_EQ(advice.cheapest, (std::vector<int>{3, 1}));
  EXPECT_EQ(
      advice.sentence,
      "For an error of 1.0e-02 at the end, use ida with block at tolerance 0.001: 2 s wall "
      "time, 3 s CPU; the next method, euler with block at tolerance 0.001, takes 5.0 times as "
      "long.");
}

TEST(Recommendation, SaysWhenTheTimesCannotTell) {
  const bench::Recommendation advice = bench::recommend(
      {point("euler", 1e-3, 1e-3, {1.9, 2.2, 2.5}), point("ida", 1e-3, 1e-3, {1.8, 2.0, 2.1})}, 0);
  EXPECT_NE(advice.sentence.find("as fast within the spread"), std::string::npos)
      << advice.sentence;
}

TEST(Recommendation, ComparesTheSpreadsNotTheMedians) {
  // The slowest of the better runs took as long as the fastest of the other ones.
  const bench::Recommendation close = bench::recommend(
      {point("euler", 1e-3, 1e-3, {2.5, 3.0, 3.5}), point("ida", 1e-3, 1e-3, {1.8, 2.0, 2.6})}, 0);
  EXPECT_NE(close.sentence.find("as fast within the spread"), std::string::npos) << close.sentence;
  const bench::Recommendation clear = bench::recommend(
      {point("euler", 1e-3, 1e-3, {2.7, 3.0, 3.5}), point("ida", 1e-3, 1e-3, {1.8, 2.0, 2.6})}, 0);
  EXPECT_NE(clear.sentence.find("takes 1.5 times as long"), std::string::npos) << clear.sentence;
}

TEST(Recommendation, NamesWhatMissedTheTargetAndSurvivesFailures) {
  bench::WorkPoint failed = point("rosenbrock", 1e-3, 0, {});
  failed.failure = "no step size";
  const std::vector<bench::WorkPoint> points = {point("euler", 1e-2, 1e-1, {1.0}),
                                                point("ida", 1e-2, 5e-3, {2.0}), failed};
  const bench::Recommendation strict = bench::recommend(points, 1e-2);
  EXPECT_EQ(strict.cheapest, (std::vector<int>{1}));
  EXPECT_EQ(strict.missed, (std::vector<std::string>{"euler with block", "rosenbrock with block"}));
  EXPECT_NE(strict.sentence.find("not reached by euler with block, rosenbrock with block"),
            std::string::npos);
  EXPECT_NE(bench::recommend(points, 1e-9).sentence.find("No method reached"), std::string::npos);
  EXPECT_EQ(bench::recommend({failed}, 0).sentence, "No combination has a result.");
}

}  // namespace
}  // namespace traceraft
