#include "verification/assimilation/filter/disagreement_map.hpp"

#include <gtest/gtest.h>

#include "kernel/core/random.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::assimilation {
namespace {

constexpr int kSpots = 600, kReplicates = 400;
constexpr double kLength = 0.2;

std::vector<Point> points_on_sphere() {
  std::vector<Point> points;
  for (int k = 0; k < kSpots; ++k) {
    const double z = 1 - (2 * k + 1.0) / kSpots, angle = 2.399963 * k, r = std::sqrt(1 - z * z);
    points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return points;
}

Columns normal_values(int columns, std::uint64_t stream) {
  Columns values(kSpots, columns);
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values.data()[i] = normal_random(stream, 0, static_cast<std::uint64_t>(i));
  return values;
}

struct Example {
  FilterProblems data;
  FilterResult pass;
};

// Noise alone, and in the second snapshot `bump` more around (0, 0, 1).
Example example(double bump) {
  Example result;
  result.data.resize(1);
  result.data[0].series.snapshots.resize(2);
  FieldSnapshot& snapshot = result.data[0].series.snapshots[1];
  snapshot.time = 3;
  snapshot.points = points_on_sphere();
  Innovation in{};
  in.snapshot = 1;
  in.values = normal_values(1, 11);
  in.replicates = normal_values(kReplicates, 12);
  for (int k = 0; k < kSpots; ++k)
    if (snapshot.points[k][2] > 0.95) in.values[k] += bump;
  in.gap = in.values;
  result.pass.innovations.push_back(in);
  return result;
}

TEST(DisagreementMaps, StandOutWhereSomethingIsMissing) {
  const Example with = example(2);
  std::vector<Point> places = points_on_sphere();
  const DisagreementMaps maps = disagreement_maps(with.data, with.pass, places, kLength);
  ASSERT_EQ(maps.snapshots.size(), 1u);
  EXPECT_EQ(maps.snapshots[0].time, 3);
  Eigen::Index most;
  EXPECT_GT(maps.snapshots[0].z.maxCoeff(&most), maps.threshold);
  EXPECT_GT(places[static_cast<std::size_t>(most)][2], 0.85);
}

// z is standard normal at each place; the threshold is that of its maximum over all of them.
TEST(DisagreementMaps, MeasureInDeviationsOfNoise) {
  const Example without = example(0);
  const DisagreementMaps maps =
      disagreement_maps(without.data, without.pass, points_on_sphere(), kLength);
  const Vec& z = maps.snapshots[0].z;
  EXPECT_NEAR(z.squaredNorm() / kSpots, 1, 0.5);
  EXPECT_LT(z.cwiseAbs().maxCoeff(), maps.threshold);
  EXPECT_GT(maps.threshold, 2.5);
  EXPECT_LT(maps.threshold, 4.5);
}

TEST(DisagreementMaps, AreZeroWhereNothingWasMeasured) {
  const Example with = example(2);
  const DisagreementMaps maps = disagreement_maps(with.data, with.pass, {Point(0, 0, 5)}, kLength);
  EXPECT_EQ(maps.snapshots[0].z[0], 0);
}

}  // namespace
}  // namespace traceraft::assimilation
