#include "verification/measure/dynamic_scaling.hpp"

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
  const Cumulative curve = cumulative_radii(areas);
  EXPECT_LT(largest_difference(curve, cumulative_radii(grown)), 1e-14);
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
  EXPECT_LT(
      largest_difference(cumulative_spectrum(spectrum(20)), cumulative_spectrum(spectrum(40))),
      0.01);
}

// Of one distribution about one pair of samples in twenty differs by more.
TEST(DynamicScaling, TheCriticalDifferenceTellsDistributionsApart) {
  int exceeded = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed)
    exceeded +=
        largest_difference(cumulative_radii(areas_of_uniform_radii(2 * seed, 80, 0.2)),
                           cumulative_radii(areas_of_uniform_radii(2 * seed + 1, 60, 0.2))) >
        critical_difference(80, 60);
  EXPECT_LE(exceeded, 20);  // radii over their own mean differ less than radii
  EXPECT_GT(largest_difference(cumulative_radii(areas_of_uniform_radii(1, 80, 0.0)),
                               cumulative_radii(areas_of_uniform_radii(2, 60, 0.8))),
            critical_difference(80, 60));
}

}  // namespace
}  // namespace traceraft
