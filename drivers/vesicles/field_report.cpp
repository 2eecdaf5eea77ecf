#include "drivers/vesicles/field_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "drivers/output/text_table.hpp"
#include "verification/explain/disagreement.hpp"
#include "verification/vesicles/history.hpp"

namespace traceraft {
namespace {

// What is stated of the noise; nothing where every value counts alike.
Cell usual_deviation(const Vec& deviation) {
  if ((deviation.array() == 1).all()) return "not stated";
  return quantile({deviation.begin(), deviation.end()}, 0.5);
}

std::vector<Cell> row_of(const FieldSeries& vesicle, const FieldSnapshot& snapshot) {
  const std::vector<Point> middles = patch_middles();
  std::set<std::size_t> patches;
  double nearest = HUGE_VAL, furthest = 0;
  for (const Point& x : snapshot.points) {
    patches.insert(nearest_patch(middles, x));
    nearest = std::min(nearest, x.norm());
    furthest = std::max(furthest, x.norm());
  }
  const double mean = snapshot.values.mean();
  const double spread = std::sqrt((snapshot.values.array() - mean).square().mean());
  return {vesicle.vesicle,
          snapshot.time,
          static_cast<double>(snapshot.points.size()),
          static_cast<double>(patches.size()),
          nearest,
          furthest,
          mean,
          spread,
          snapshot.values.minCoeff(),
          snapshot.values.maxCoeff(),
          usual_deviation(snapshot.deviation)};
}

bool has_far_points(const FieldDataset& data) {
  for (const FieldSeries& vesicle : data.vesicles)
    for (const FieldSnapshot& snapshot : vesicle.snapshots)
      for (const Point& x : snapshot.points)
        if (x.norm() < 0.5 || x.norm() > 2) return true;
  return false;
}

}  // namespace

void print_fields(const FieldDataset& data) {
  std::printf("%s%s: measured fields of %zu vesicle%s, R = %g um%s%s\n", data.name.c_str(),
              data.synthetic ? " (SYNTHETIC)" : "", data.vesicles.size(),
              data.vesicles.size() == 1 ? "" : "s", data.radius_um, data.origin.empty() ? "" : "; ",
              data.origin.c_str());
  if (data.blur_um)
    std::printf("images blurred by %g um\n", *data.blur_um);
  else
    std::printf("NOTE: how blurred the images are is not said (blur, 0 if they are not)\n");
  Table table{"fields",
              {"vesicle", "time (s)", "points", "patches of 12", "|x|/R from", "to", "mean of c",
               "deviation of c", "least", "largest", "sigma"},
              {}};
  for (const FieldSeries& vesicle : data.vesicles)
    for (const FieldSnapshot& snapshot : vesicle.snapshots)
      table.rows.push_back(row_of(vesicle, snapshot));
  print_rows(table_rows(table));
  if (has_far_points(data))
    std::printf(
        "NOTE: some points are far from a sphere of that radius: is the unit of length "
        "right, and the centre at 0?\n");
}

}  // namespace traceraft
