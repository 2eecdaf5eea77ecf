#include "verification/selection/search/neighbours.hpp"

#include <gtest/gtest.h>

namespace traceraft::selection {
namespace {

constexpr double kEnough = 10000;

assimilation::Hypothesis::Part part(const std::string& effect, double coefficient) {
  const assimilation::Candidate c = assimilation::find_candidate(effect).value();
  return {c, std::vector<double>(static_cast<std::size_t>(c.directions), coefficient)};
}

Refit refit_of(const std::vector<assimilation::Hypothesis::Part>& parts, double deviance,
               double sigma = 0.01) {
  Refit fit;
  fit.hypothesis.parts = parts;
  fit.deviance = deviance;
  const Eigen::Index n = fit.hypothesis.coefficients();
  fit.covariance = sigma * sigma * Eigen::MatrixXd::Identity(n, n);
  return fit;
}

// Uptake was taken where exchange came near; then gravity, alone.
std::vector<Round> rounds() {
  std::vector<Round> result(2);
  result[0].without = refit_of({}, 1000);
  result[0].refits = {refit_of({part("uptake", 1)}, 800), refit_of({part("exchange", 1)}, 850),
                      refit_of({part("cooling", 1)}, 950)};
  result[1].without = refit_of({part("uptake", 1)}, 800);
  result[1].refits = {refit_of({part("uptake", 1), part("gravity", 1)}, 700)};
  return result;
}

std::vector<std::string> names(const std::vector<assimilation::Hypothesis>& hypotheses) {
  std::vector<std::string> result;
  for (const assimilation::Hypothesis& h : hypotheses) result.push_back(h.name());
  return result;
}

TEST(Neighbours, ReplaceByWhatCameNear) {
  const Refit fit = refit_of({part("uptake", 1), part("gravity", 1)}, 700);
  EXPECT_EQ(names(neighbours(fit, rounds(), kEnough, assimilation::candidates())),
            std::vector<std::string>{"exchange + gravity"});
}

TEST(Neighbours, OfOneEffectAreThoseThatCameNear) {
  EXPECT_EQ(names(neighbours(refit_of({part("uptake", 1)}, 800), rounds(), kEnough,
                             assimilation::candidates())),
            std::vector<std::string>{"exchange"});
}

TEST(Neighbours, TakeNothingThatIsNotAllowed) {
  const Refit fit = refit_of({part("uptake", 1), part("gravity", 1)}, 700);
  EXPECT_TRUE(neighbours(fit, rounds(), kEnough, {part("cooling", 1).candidate}).empty());
}

TEST(Neighbours, DropWhatIsUncertain) {
  const Refit fit = refit_of({part("uptake", 1), part("gravity", 0.02)}, 700);
  const auto found = names(neighbours(fit, rounds(), kEnough, {}));
  EXPECT_EQ(found, std::vector<std::string>{"uptake"});
  EXPECT_TRUE(neighbours(refit_of({part("gravity", 0.02)}, 700), rounds(), kEnough, {}).empty());
}

}  // namespace
}  // namespace traceraft::selection
