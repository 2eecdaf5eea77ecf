#include "verification/observations/differences.hpp"

#include <gtest/gtest.h>

namespace traceraft::observations {
namespace {

MeasuredVesicles vesicles(const std::vector<double>& radii, const std::vector<double>& fractions) {
  MeasuredVesicles data;
  for (std::size_t k = 0; k < radii.size(); ++k)
    for (const double change : {-0.01, 0.01}) {
      Measurement m{std::to_string(k), 10 + change, radii[k], {}, {}};
      m.values[static_cast<std::size_t>(Quantity::fraction)] = fractions[k] + change;
      m.values[static_cast<std::size_t>(Quantity::rafts)] = 3;
      data.measurements.push_back(m);
    }
  return data;
}

TEST(Differences, AreSilentWhereOneModelStandsForAll) {
  EXPECT_TRUE(differences(vesicles({4.6, 5, 5.5}, {0.09, 0.1, 0.12}), {5, 0.1}).empty());
  // Nothing is known of a fraction that was not measured twice.
  EXPECT_TRUE(differences(vesicles({5}, {0.3}), {5, 0.1}).empty());
}

TEST(Differences, NameRadiiAndFractions) {
  const auto large = differences(vesicles({5, 5, 8.5}, {0.09, 0.1, 0.12}), {5, 0.1});
  ASSERT_EQ(large.size(), 1u);
  EXPECT_NE(large[0].find("5 to 8.5 um (median 5 um)"), std::string::npos) << large[0];
  EXPECT_NE(large[0].find("D would be 2 times as large"), std::string::npos) << large[0];
  const auto other = differences(vesicles({5, 5, 5}, {0.15, 0.16, 0.155}), {5, 0.1});
  ASSERT_EQ(other.size(), 1u);
  EXPECT_NE(other[0].find("0.155 of the area of the vesicles"), std::string::npos) << other[0];
}

TEST(Differences, SizeCountsWithItsFourthPower) {
  EXPECT_NEAR(factor_of_size(vesicles({6, 6}, {0.1, 0.1}), 6), 1, 1e-12);
  EXPECT_NEAR(factor_of_size(vesicles({3, 12}, {0.1, 0.1}), 3), 16, 1e-9);
  MeasuredVesicles some = vesicles({3, 12}, {0.1, 0.1});
  for (Measurement& m : some.measurements)
    if (m.radius > 3) m.values[static_cast<std::size_t>(Quantity::rafts)] = 0;  // tells nothing
  EXPECT_NEAR(factor_of_size(some, 3), 1, 1e-12);
}

// Rafts cover less than the share of raft lipids: what counts is what would be measured.
TEST(Differences, AreThoseFromWhatRunsShow) {
  History run;
  run.time = {1, 9.9, 100};
  run.of(Quantity::fraction) = {0.16, 0.12, 0.05};
  const SimulatedVesicle found = simulated_vesicle(5, {run, run}, vesicles({5, 5}, {0.12, 0.13}));
  EXPECT_EQ(found.radius, 5);
  EXPECT_NEAR(found.raft_fraction, 0.12, 0.001);
}

}  // namespace
}  // namespace traceraft::observations
