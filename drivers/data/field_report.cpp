#include "drivers/data/field_report.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "drivers/output/text_table.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/text.hpp"
#include "verification/assimilation/filter/disagreement.hpp"
#include "verification/assimilation/filter/field_noise.hpp"
#include "verification/observations/history.hpp"

namespace traceraft::data {
namespace {

// The median of the stated noise; "not stated" where every value counts alike.
bench::Cell usual_deviation(const Vec& deviation) {
  if ((deviation.array() == 1).all()) return "not stated";
  return statistics::quantile({deviation.begin(), deviation.end()}, 0.5);
}

std::vector<bench::Cell> row_of(const assimilation::FieldSeries& vesicle,
                                const assimilation::FieldSnapshot& snapshot) {
  const std::vector<Point> middles = assimilation::patch_middles();
  std::set<std::size_t> patches;
  double nearest = HUGE_VAL, furthest = 0;
  for (const Point& x : snapshot.points) {
    patches.insert(assimilation::nearest_patch(middles, x));
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

// Notes on what `explain` would refuse, with a sphere and the usual wells: the first of each kind.
std::vector<std::string> notes_on(const std::filesystem::path& folder,
                                  const input::FieldDataset& data) {
  std::string off_sphere, off_scale;
  std::size_t number = 0;
  for (const assimilation::FieldSeries& vesicle : data.vesicles)
    for (const assimilation::FieldSnapshot& snapshot : vesicle.snapshots) {
      ++number;
      const auto distance = [](const Point& x) { return std::fabs(x.norm() - 1); };
      const auto far = std::max_element(
          snapshot.points.begin(), snapshot.points.end(),
          [&](const Point& a, const Point& b) { return distance(a) < distance(b); });
      if (off_sphere.empty() && distance(*far) > assimilation::kOffSurface)
        off_sphere =
            input::place_of(folder, number,
                            static_cast<std::size_t>(far - snapshot.points.begin())) +
            formatted(
                ": the distance of a point from the sphere of this radius is %.2g R, and explain "
                "refuses more than %g R. Are radius and length_unit right, and is the centre at 0?",
                distance(*far), assimilation::kOffSurface);
      Eigen::Index row = 0;
      (snapshot.values.array() - 0.5).abs().maxCoeff(&row);
      const double c = snapshot.values[row];
      if (off_scale.empty() && (c < -input::kFarFromWells || c > 1 + input::kFarFromWells))
        off_scale = input::place_of(folder, number, static_cast<std::size_t>(row), "c") +
                    formatted(
                        ": %g; explain expects about 0 outside rafts and 1 inside (unless --well "
                        "says otherwise). Leave out missing values, and scale c.",
                        c);
    }
  std::vector<std::string> notes;
  for (std::string* note : {&off_sphere, &off_scale})
    if (!note->empty()) notes.push_back(std::move(*note));
  if (const std::string note = input::note_on_distance(data); !note.empty()) notes.push_back(note);
  if (const std::string note = input::note_on_scale(data, 0, 1); !note.empty() && off_scale.empty())
    notes.push_back(note);
  if (!data.blur_um)
    notes.push_back(
        "dataset.toml does not state the blur of the images (key blur; 0 for sharp images)");
  return notes;
}

}  // namespace

void print_fields(const std::filesystem::path& folder, const input::FieldDataset& data) {
  text::say("%s%s: measured fields of %zu vesicle%s, R = %g um%s%s\n", data.name,
            data.synthetic ? " (SYNTHETIC)" : "", data.vesicles.size(),
            data.vesicles.size() == 1 ? "" : "s", data.radius_um, data.origin.empty() ? "" : "; ",
            data.origin);
  if (data.blur_um) text::say("images blurred by %g um\n", *data.blur_um);
  bench::Table table{"fields",
                     {"vesicle", "time (s)", "points", "patches of 12", "|x|/R from", "to",
                      "mean of c", "deviation of c", "least", "largest", "usual sigma"},
                     {}};
  for (const assimilation::FieldSeries& vesicle : data.vesicles)
    for (const assimilation::FieldSnapshot& snapshot : vesicle.snapshots)
      table.rows.push_back(row_of(vesicle, snapshot));
  output::print_rows(output::table_rows(table));
  if (const std::optional<assimilation::FieldNoise> noise =
          assimilation::noise_of_fields(data.vesicles, 1))
    text::say("noise in flat parts of the fields: about %.3g, %s (R = %g um)\n", noise->level,
              assimilation::text_of(noise->correlation), data.radius_um);
  for (const std::string& note : notes_on(folder, data)) text::say("NOTE: %s\n", note);
}

}  // namespace traceraft::data
