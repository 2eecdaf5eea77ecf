#include "drivers/input/field_dataset.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "backends/posix/durable_file.hpp"
#include "drivers/config/toml_table.hpp"
#include "drivers/input/csv_table.hpp"
#include "drivers/input/measured_units.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::input {
namespace {

namespace fs = std::filesystem;

// Fewer points cannot show a field.
constexpr std::size_t kFewestPoints = 100;
// Ratio of standard deviations within a snapshot.
constexpr double kMostUnlike = 1e6;

std::vector<double> numbers_of(const config::TomlTable& toml, const std::string& key) {
  if (!toml.has(key)) throw InputError(toml.where(key) + ": it is missing");
  if (const auto* list = std::get_if<std::vector<double>>(&toml.value(key))) return *list;
  throw InputError(toml.where(key) + ": a list of numbers is needed here");
}

void check_columns(const CsvTable& table) {
  const std::vector<std::string> known = {"x", "y", "z", "c", "sigma"};
  for (const char* needed : {"x", "y", "z", "c"}) table.require(needed);
  for (const std::string& column : table.columns())
    if (std::find(known.begin(), known.end(), column) == known.end())
      throw InputError(table.path().string() + ": " +
                       unknown_name_message("column", column, known));
  if (table.rows() < kFewestPoints)
    throw InputError(table.path().string() + ": " + std::to_string(table.rows()) +
                     " points are too few for a field (needed: at least " +
                     std::to_string(kFewestPoints) + ")");
}

assimilation::FieldSnapshot read_snapshot(const CsvTable& table, double time, double to_radius) {
  check_columns(table);
  const auto rows = static_cast<Eigen::Index>(table.rows());
  assimilation::FieldSnapshot snapshot{time, {}, Vec(rows), Vec::Ones(rows)};
  for (std::size_t row = 0; row < table.rows(); ++row) {
    snapshot.points.push_back(
        to_radius * Point(table.number(row, "x"), table.number(row, "y"), table.number(row, "z")));
    const auto i = static_cast<Eigen::Index>(row);
    snapshot.values[i] = table.number(row, "c");
    if (!table.has("sigma")) continue;
    snapshot.deviation[i] = table.number(row, "sigma");
    if (!(snapshot.deviation[i] > 0))
      throw InputError(table.where(row, "sigma") + ": a standard deviation must be positive");
  }
  // A value that is a million times as certain as the rest decides alone.
  if (snapshot.deviation.maxCoeff() > kMostUnlike * snapshot.deviation.minCoeff())
    throw InputError(table.path().string() +
                     ", column sigma: the largest is more than a million times the smallest, " +
                     format_number(snapshot.deviation.minCoeff()));
  return snapshot;
}

void read_blur(const config::TomlTable& toml, double length, FieldDataset& data) {
  if (!toml.has("blur")) return;
  data.blur_um = toml.number("blur") * length;
  if (!(*data.blur_um >= 0 && *data.blur_um < kWidestBlur * data.radius_um))
    throw InputError(
        toml.where("blur") +
        formatted(": it must be from 0 to %.2g of the radius (a standard deviation)", kWidestBlur));
}

void read_noise(const config::TomlTable& toml, double length, FieldDataset& data) {
  const char *size = "noise_correlation", *share = "noise_share";
  if (toml.has(size) != toml.has(share))
    throw InputError(toml.where(toml.has(size) ? size : share) + ": it needs " +
                     (toml.has(size) ? share : size));
  if (!toml.has(size)) return;
  data.noise_correlation_um = toml.number(size) * length;
  data.noise_share = toml.number(share);
  if (!(data.noise_share >= 0 && data.noise_share <= 1))
    throw InputError(toml.where(share) + ": it must be from 0 to 1, as a share of the variance");
  if (!(data.noise_correlation_um > 0 &&
        data.noise_correlation_um <= assimilation::kLongestCorrelation * data.radius_um))
    throw InputError(toml.where(size) + formatted(": it must be from 0 to %.2g of the radius",
                                                  assimilation::kLongestCorrelation));
}

// Whose each snapshot is.
std::vector<std::string> vesicles_of(const config::TomlTable& toml, std::size_t snapshots) {
  const std::vector<double> numbers =
      toml.has("vesicles") ? numbers_of(toml, "vesicles") : std::vector<double>(snapshots, 1.0);
  if (numbers.size() != snapshots)
    throw InputError(toml.where("vesicles") + ": " + std::to_string(numbers.size()) +
                     " vesicles for " + std::to_string(snapshots) + " times");
  std::vector<std::string> names;
  for (const double number : numbers) names.push_back(format_number(number));
  return names;
}

// The series of a vesicle whose snapshots follow each other.
assimilation::FieldSeries& series_of(const config::TomlTable& toml, const std::string& vesicle,
                                     FieldDataset& data) {
  auto& all = data.vesicles;
  if (!all.empty() && all.back().vesicle == vesicle) return all.back();
  for (const assimilation::FieldSeries& before : all)
    if (before.vesicle == vesicle)
      throw InputError(toml.where("vesicles") + ": snapshots of vesicle " + vesicle +
                       " must follow each other");
  all.push_back({vesicle, {}});
  return all.back();
}

void refuse_incomplete(const fs::path& folder, const config::TomlTable& toml, std::size_t snapshots,
                       const FieldDataset& data) {
  for (const assimilation::FieldSeries& series : data.vesicles)
    if (series.snapshots.size() < 2)
      throw InputError(toml.where("times") + ": vesicle " + series.vesicle +
                       " needs two snapshots or more");
  if (const fs::path more = folder / snapshot_file(snapshots + 1); fs::exists(more))
    throw InputError(toml.where("times") + ": " + std::to_string(snapshots) +
                     " times, but there is " + more.filename().string());
  if (data.vesicles.empty()) throw InputError(toml.where("times") + ": there is no snapshot");
}

}  // namespace

std::string place_of(const fs::path& folder, std::size_t snapshot, std::size_t row,
                     const std::string& column) {
  const CsvTable table = CsvTable::read(folder / snapshot_file(snapshot));
  return column.empty() ? table.where(row) : table.where(row, column);
}

FieldDataset read_field_dataset(const fs::path& folder) {
  if (!holds_fields(folder) && holds_series(folder))
    throw InputError(folder.string() + " holds series of vesicles, not fields");
  const config::TomlTable toml = read_field_description(folder);
  FieldDataset data;
  data.name = toml.text("name");
  data.origin = toml.text_or("origin", "");
  data.time_zero = toml.text_or("time_zero", "");
  data.synthetic = toml.has("kind") && is_synthetic(toml);
  data.composition = composition_of(toml);
  (void)celsius_of(toml);
  const double length = length_factor(toml, "length_unit"), second = time_factor(toml, "time_unit"),
               offset = time_offset(toml);
  data.radius_um = checked_radius(toml.number("radius") * length, toml.where("radius"));
  read_blur(toml, length, data);
  read_noise(toml, length, data);
  const std::vector<double> times = numbers_of(toml, "times");
  const std::vector<std::string> vesicles = vesicles_of(toml, times.size());
  bool with_sigma = false;
  for (std::size_t k = 0; k < times.size(); ++k) {
    auto& snapshots = series_of(toml, vesicles[k], data).snapshots;
    const double time = checked_time((times[k] + offset) * second, toml.where("times"));
    if (!snapshots.empty() && !(time > snapshots.back().time))
      throw InputError(toml.where("times") + ": times of a vesicle must ascend");
    const fs::path file = folder / snapshot_file(k + 1);
    if (!fs::exists(file))
      throw InputError(toml.where("times") + ": " + std::to_string(times.size()) +
                       " times, but there is no " + file.filename().string());
    const CsvTable table = CsvTable::read(file);
    if (k == 0) with_sigma = table.has("sigma");
    if (table.has("sigma") != with_sigma)
      throw InputError(
          table.path().string() +
          ": only some snapshots have a column sigma; the noise of the others is then unknown");
    snapshots.push_back(read_snapshot(table, time, length / data.radius_um));
  }
  refuse_incomplete(folder, toml, times.size(), data);
  return data;
}

std::string note_on_distance(const FieldDataset& data) {
  constexpr double kFar = 0.02;
  std::vector<double> distances;
  for (const assimilation::FieldSeries& vesicle : data.vesicles)
    for (const assimilation::FieldSnapshot& snapshot : vesicle.snapshots)
      for (const Point& x : snapshot.points) distances.push_back(x.norm());
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  if (std::fabs(*middle - 1) <= kFar) return "";
  return formatted(
      "The median distance of the points from the centre is %.4g um, but the stated radius is %.4g "
      "um. Is it right?",
      *middle * data.radius_um, data.radius_um);
}

std::string note_on_scale(const FieldDataset& data, double a, double b) {
  constexpr double kFar = 0.5, kMost = 0.2;  // of the distance of the phases, of the values
  double far = 0, all = 0;
  for (const assimilation::FieldSeries& vesicle : data.vesicles)
    for (const assimilation::FieldSnapshot& snapshot : vesicle.snapshots) {
      const auto c = snapshot.values.array();
      far += static_cast<double>((c < a - kFar * (b - a) || c > b + kFar * (b - a)).count());
      all += static_cast<double>(c.size());
    }
  if (far <= kMost * all) return "";
  return formatted(
      "%.0f %% of the values of c differ from the phases, %g and %g, by more than half of the "
      "distance of the phases. Is c on this scale?",
      100 * far / all, a, b);
}

void write_field_dataset(const fs::path& folder, const FieldDataset& data,
                         const std::string& remark) {
  const auto quoted = [](const std::string& text) { return nlohmann::json(text).dump(); };
  fs::create_directories(folder);
  std::string times, vesicles;
  std::size_t number = 0;
  for (const assimilation::FieldSeries& series : data.vesicles)
    for (const assimilation::FieldSnapshot& snapshot : series.snapshots) {
      const bool weighted = !(snapshot.deviation.array() == 1).all();
      std::string csv = weighted ? "x,y,z,c,sigma\n" : "x,y,z,c\n";
      for (std::size_t i = 0; i < snapshot.points.size(); ++i) {
        const Point x = data.radius_um * snapshot.points[i];
        const auto row = static_cast<Eigen::Index>(i);
        csv += formatted("%.9g,%.9g,%.9g,%.6g", x[0], x[1], x[2], snapshot.values[row]);
        csv += weighted ? formatted(",%.6g\n", snapshot.deviation[row]) : "\n";
      }
      posix::write_durably(folder / snapshot_file(++number), csv);
      times += (times.empty() ? "" : ", ") + format_number(snapshot.time);
      vesicles += (vesicles.empty() ? "" : ", ") + series.vesicle;
    }
  posix::write_durably(
      folder / "dataset.toml",
      "# " + remark + "\nname = " + quoted(data.name) +
          "\nkind = " + (data.synthetic ? "\"synthetic\"" : "\"measured\"") +
          "\norigin = " + quoted(data.origin) + "\ntime_zero = " + quoted(data.time_zero) +
          "\nlength_unit = \"um\"\ntime_unit = \"s\"\nradius = " + format_number(data.radius_um) +
          (data.blur_um ? "\nblur = " + format_number(*data.blur_um) : "") +
          (data.noise_share > 0
               ? "\nnoise_correlation = " + format_number(data.noise_correlation_um) +
                     "\nnoise_share = " + format_number(data.noise_share)
               : "") +
          "\ntimes = [" + times + "]\nvesicles = [" + vesicles + "]\n");
}

}  // namespace traceraft::input
