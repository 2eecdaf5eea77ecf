// Against Table 1 and the temperatures of Zhiliakov et al., BBA Biomembranes 1863 (2021) 183446.
#include "verification/observations/raft_fraction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/core/error.hpp"

namespace traceraft::observations {
namespace {

double estimate(const std::string& composition, double celsius) {
  return estimated_raft_fraction(membrane_mixture("", composition), celsius).area;
}

TEST(RaftFraction, ReadsMixtures) {
  const LipidMixture membrane = membrane_mixture("x", "3:1:20%");
  EXPECT_DOUBLE_EQ(membrane.dopc, 0.6);
  EXPECT_DOUBLE_EQ(membrane.dppc, 0.2);
  EXPECT_DOUBLE_EQ(membrane.cholesterol, 0.2);
  EXPECT_DOUBLE_EQ(phase_mixture("x", "22:43:35").dppc, 0.43);
  EXPECT_DOUBLE_EQ(membrane_mixture("x", "3:1:0.2 %").cholesterol, 0.002);
  EXPECT_DOUBLE_EQ(membrane_mixture("x", "3:1:0").cholesterol, 0);
  for (const char* wrong :
       {"", "3", "3:1", "3:1:20:4", "a:1:20", "3:-1:20", "3:1:100", "0:0:20", "3:1:0.2"})
    EXPECT_THROW(membrane_mixture("x", wrong), InputError) << wrong;
  EXPECT_THROW(phase_mixture("x", "22:43:30"), InputError);
}

// The published shares of lipids, 0.13/0.86 and 0.17/0.83, are cut to two digits; areas agree to
// the last digit published.
TEST(RaftFraction, OfThePublishedTieLines) {
  const CoexistingPhases at_15{{0.22, 0.43, 0.35}, {0.66, 0.16, 0.18}},
      at_20{{0.20, 0.48, 0.32}, {0.60, 0.22, 0.18}};
  const RaftFraction three = raft_fraction(membrane_mixture("", "3:1:20"), at_15, 15);
  EXPECT_NEAR(three.lipids, 0.13, 0.01);
  EXPECT_NEAR(three.area, 0.108, 0.0005);
  const RaftFraction two = raft_fraction(membrane_mixture("", "2:1:20"), at_20, 20);
  EXPECT_NEAR(two.lipids, 0.17, 0.005);
  EXPECT_NEAR(two.area, 0.136, 0.0005);
}

TEST(RaftFraction, AtTheTemperaturesOfTheMeasurements) {
  EXPECT_NEAR(estimate("2:1:20", 19.2), 0.156, 0.0005);
  EXPECT_NEAR(estimate("3:1:20", 17.5), 0.087, 0.0005);
  EXPECT_DOUBLE_EQ(estimate("2:1:20", 17.5), 0.199);
  EXPECT_DOUBLE_EQ(estimate("3:1:20", 10), 0.149);
}

TEST(RaftFraction, RefusesWhatNothingIsKnownOf) {
  EXPECT_THROW(estimate("1:1:20", 20), InputError);
  EXPECT_THROW(estimate("2:1:20", 37), InputError);
  const CoexistingPhases phases{{0.22, 0.43, 0.35}, {0.66, 0.16, 0.18}};
  EXPECT_THROW(raft_fraction(membrane_mixture("", "9:1:20"), phases, 15), InputError);
}

TEST(RaftFraction, RefusesAMembraneOffTheTieLine) {
  const CoexistingPhases phases{{0.22, 0.43, 0.35}, {0.66, 0.16, 0.18}};
  // Its DOPC lies between those of the phases, its cholesterol does not.
  EXPECT_THROW((void)raft_fraction(membrane_mixture("", "2:1:50"), phases, 15), InputError);
  EXPECT_NO_THROW((void)raft_fraction(membrane_mixture("", "3:1:20"), phases, 15));
  EXPECT_THROW((void)estimate("3:1:20", std::nan("")), InputError);
  EXPECT_TRUE(same_membrane("3:1:20", "6:2:20%"));
  EXPECT_FALSE(same_membrane("3:1:20", "2:1:20"));
}

// By hand: of each phase half of the lipids. At 20 C a lipid beside 20 % of cholesterol has
// 72 - 9.5 - 1.4 = 61.1 and 46 - 2.88 - 0.95 = 42.17 square angstroms.
TEST(RaftFraction, IsSmallerThanThatOfLipidsWhereDppcPrevails) {
  const CoexistingPhases phases{{0.3, 0.5, 0.2}, {0.5, 0.3, 0.2}};
  const RaftFraction half = raft_fraction({0.4, 0.4, 0.2}, phases, 20);
  EXPECT_DOUBLE_EQ(half.lipids, 0.5);
  EXPECT_NEAR(half.area, 39.415 / (39.415 + 43.201), 1e-9);
}

TEST(RaftFraction, RefusesPhasesWithoutPhospholipid) {
  EXPECT_THROW((void)phase_mixture("x", "0:0:100"), InputError);
}

}  // namespace
}  // namespace traceraft::observations
