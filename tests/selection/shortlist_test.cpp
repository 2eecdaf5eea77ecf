// Shortlists of screenings that are written down by hand.
#include "verification/selection/search/shortlist.hpp"

#include <gtest/gtest.h>

namespace traceraft::selection {
namespace {

CandidateScore score(const std::string& effect, double gained) {
  const assimilation::Candidate candidate = assimilation::find_candidate(effect).value();
  CandidateScore result{};
  result.effect = effect;
  result.coefficients.assign(candidate.directions, gained > 0 ? 0.1 : 0);
  result.score = gained;
  result.covariance = 0.04 * Eigen::MatrixXd::Identity(candidate.directions, candidate.directions);
  return result;
}

std::vector<std::string> names(const std::vector<assimilation::Hypothesis::Part>& parts) {
  std::vector<std::string> result;
  for (const auto& part : parts) result.push_back(part.candidate.name);
  return result;
}

using Names = std::vector<std::string>;
constexpr double kLimit = 6;  // what tells two of them apart

TEST(Shortlist, HoldsWhatGainsAQuarterOfTheBest) {
  Screening screening;
  screening.scores = {score("gravity", 100), score("uptake", 30), score("exchange", 26),
                      score("allen-cahn", 24)};
  EXPECT_EQ(names(shortlist(screening, 5, kLimit)), (Names{"gravity", "uptake", "exchange"}));
  EXPECT_EQ(names(shortlist(screening, 2, kLimit)), (Names{"gravity", "uptake"}));
  EXPECT_EQ(shortlist(screening, 5, kLimit)[0].coefficients, std::vector<double>{0.1});
}

TEST(Shortlist, HoldsASecondOneToCompareWith) {
  Screening screening;
  screening.scores = {score("gravity", 7), score("uptake", 1), score("exchange", 0.5)};
  EXPECT_EQ(names(shortlist(screening, 5, kLimit)), (Names{"gravity", "uptake"}));
  screening.scores = {};
  EXPECT_TRUE(shortlist(screening, 5, kLimit).empty());
}

// Where the mesh is coarse, little tells effects apart, and more of them have to be tried.
TEST(Shortlist, HoldsWhatCouldBeTheBestOne) {
  Screening screening;
  screening.scores = {score("gravity", 100), score("uptake", 30), score("exchange", 16),
                      score("allen-cahn", 14)};
  EXPECT_EQ(names(shortlist(screening, 5, 85)), (Names{"gravity", "uptake", "exchange"}));
  EXPECT_EQ(names(shortlist(screening, 2, 85)), (Names{"gravity", "uptake"}));
}

// Another D takes the place of a little bulk mobility, not of much.
TEST(Shortlist, HoldsWhatResemblesAnotherDiffusionRatioHoweverLittleItGains) {
  Screening screening;
  screening.scores = {score("gravity", 100), score("uptake", 30), score("exchange", 26),
                      score("mobility-exponent", 2), score("bulk-mobility", 0)};
  const auto parts = shortlist(screening, 2, kLimit);
  EXPECT_EQ(names(parts), (Names{"gravity", "uptake", "mobility-exponent", "bulk-mobility"}));
  EXPECT_EQ(parts[2].coefficients, std::vector<double>{0.1});
  EXPECT_NEAR(parts[3].coefficients[0], 0.2, 1e-12);
}

}  // namespace
}  // namespace traceraft::selection
