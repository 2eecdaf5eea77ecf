#include "verification/assimilation/fields/outliers.hpp"

#include <gtest/gtest.h>

#include "kernel/core/random.hpp"

namespace traceraft::assimilation {
namespace {

constexpr int kPoints = 2000;
constexpr double kNoise = 0.03, kLeast = 0.2;

// Values around a field that is 0.
FieldSnapshot snapshot() {
  FieldSnapshot result{0, {}, Vec(kPoints), Vec::Ones(kPoints)};
  for (int k = 0; k < kPoints; ++k) {
    result.points.emplace_back(k, 0, 0);
    result.values[k] = kNoise * normal_random(1, 1, static_cast<std::uint64_t>(k));
  }
  return result;
}

TEST(Outliers, AreDroppedWithTheirPlaces) {
  FieldSnapshot measured = snapshot();
  measured.values[7] = 1;
  measured.values[1500] = -0.8;
  EXPECT_EQ(drop_outliers(Vec::Zero(kPoints), kLeast, measured), 2u);
  ASSERT_EQ(measured.values.size(), kPoints - 2);
  ASSERT_EQ(measured.deviation.size(), kPoints - 2);
  ASSERT_EQ(measured.points.size(), std::size_t{kPoints - 2});
  EXPECT_EQ(measured.points[7][0], 8);
  EXPECT_LT(measured.values.cwiseAbs().maxCoeff(), kLeast);
}

TEST(Outliers, AreNotWhatNoiseExplains) {
  FieldSnapshot measured = snapshot();
  EXPECT_EQ(drop_outliers(Vec::Zero(kPoints), 0, measured), 0u);
  measured.values[7] = 1;
  measured.deviation[7] = 1 / kNoise;  // as uncertain as it is far
  EXPECT_EQ(drop_outliers(Vec::Zero(kPoints), 0, measured), 0u);
}

// A value at less than half of the distance of the furthest may be the furthest's doing.
TEST(Outliers, AreTheFurthestFirst) {
  FieldSnapshot measured = snapshot();
  measured.values[7] = 2;
  measured.values[8] = -0.5;
  EXPECT_EQ(drop_outliers(Vec::Zero(kPoints), kLeast, measured), 1u);
  EXPECT_EQ(drop_outliers(Vec::Zero(kPoints - 1), kLeast, measured), 1u);
}

TEST(Outliers, AreNoShallowGap) {
  FieldSnapshot measured = snapshot();
  measured.values[7] = 0.9 * kLeast;
  EXPECT_EQ(drop_outliers(Vec::Zero(kPoints), kLeast, measured), 0u);
}

}  // namespace
}  // namespace traceraft::assimilation
