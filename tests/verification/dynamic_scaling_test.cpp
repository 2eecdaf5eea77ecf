#include "verification/bench/dynamic_scaling.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/core/random.hpp"
#include "kernel/core/types.hpp"

namespace traceraft {
namespace {

std::vector<double> areas_of_uniform_radii(std::uint64_t seed, std::size_t count, double low) {
  std::vector<double> areas;
  for (std::size_t k = 0; k < count; ++k)
    areas.push_back(kPi * std::pow(low + (1 - low) * uniform_random(seed, 7, k), 2));
  return areas;
}

TEST(DynamicScaling, SizesInUnitsOfTheirMeanAreOneDistribution) {
  const std::vector<double> areas = {1, 4, 9, 16};
  std::vector<double> grown;
  for (const double area : areas) grown.push_back(6.25 * area);
  const bench::Cumulative curve = bench::cumulative_radii(areas);
  EXPECT_LT(bench::largest_difference(curve, bench::cumulative_radii(grown)), 1e-14);
  ASSERT_EQ(curve.size(), 5u);  // radii 1, 2, 3, 4 over 2.5
  EXPECT_NEAR(curve[1].first, 0.4, 1e-14);
  EXPECT_NEAR(curve[2].second, 0.5, 1e-14);
}

TEST(DynamicScaling, SpectraInUnitsOfTheirMedianDegreeAreOneDistribution) {
  const auto spectrum = [](double scale) {
    std::vector<double> power = {100};  // degree 0 does not take part
    for (int l = 1; l < 2000; ++l)
      power.push_back(std::exp(-std::pow(std::log(l / scale), 2)) / scale);
    return power;
  };
  EXPECT_LT(bench::largest_difference(bench::cumulative_spectrum(spectrum(20)),
                                      bench::cumulative_spectrum(spectrum(40))),
            0.01);
}

// Samples of one distribution differ in two of 32 cases by more than 6 members can be exchanged to.
TEST(DynamicScaling, TheDifferenceOfChanceTellsDistributionsApart) {
  const auto members = [](std::uint64_t seed, int count, double least) {
    std::vector<std::vector<double>> all;
    for (std::uint64_t k = 0; k < 6; ++k)
      all.push_back(areas_of_uniform_radii(10 * seed + k, count, least));
    return all;
  };
  const auto difference = [](const std::vector<std::vector<double>>& a,
                             const std::vector<std::vector<double>>& b) {
    std::vector<double> first, second;
    for (const auto& areas : a) first.insert(first.end(), areas.begin(), areas.end());
    for (const auto& areas : b) second.insert(second.end(), areas.begin(), areas.end());
    return bench::largest_difference(bench::cumulative_radii(first),
                                     bench::cumulative_radii(second));
  };
  constexpr int kPairs = 400;
  int exceeded = 0;
  for (std::uint64_t seed = 0; seed < kPairs; ++seed) {
    const auto early = members(2 * seed, 13, 0.2), late = members(2 * seed + 1, 10, 0.2);
    exceeded += difference(early, late) > bench::chance_difference(early, late);
  }
  EXPECT_NEAR(exceeded, kPairs * 2 / 32.0, 3 * std::sqrt(kPairs * 2 / 32.0));
  const auto narrow = members(1, 13, 0.8), wide = members(2, 10, 0.0);
  // Where one member of six is exchanged two thirds of a difference are left.
  EXPECT_GT(difference(narrow, wide), 1.2 * bench::chance_difference(narrow, wide));
  EXPECT_THROW((void)bench::chance_difference(narrow, {}), std::invalid_argument);
}

}  // namespace
}  // namespace traceraft
