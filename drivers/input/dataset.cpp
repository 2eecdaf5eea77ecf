#include "drivers/input/dataset.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "backends/posix/durable_file.hpp"
#include "drivers/input/csv_table.hpp"
#include "drivers/input/measured_units.hpp"
#include "drivers/input/toml_table.hpp"
#include "drivers/output/csv.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/types.hpp"
#include "verification/vesicles/raft_fraction.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

// Vesicles that a light microscope shows; what is outside is in other units than it says.
constexpr double kSmallestRadius = 0.05, kLargestRadius = 1000;  // µm
constexpr double kLargestPerimeter = 1000;                       // over the radius
constexpr double kMostRafts = 1e6;
constexpr double kLatest = 1e9;                   // s
constexpr double kColdest = -20, kHottest = 100;  // °C
// Of one vesicle between looks; and by how much a perimeter may be shorter than the shortest one
// of its area: both are read off images.
constexpr double kSameRadius = 1.2, kTooShort = 0.5;

double checked_radius(double radius, const std::string& where) {
  if (radius >= kSmallestRadius && radius <= kLargestRadius) return radius;
  throw InputError(where + ": a vesicle of radius " + format_number(radius) +
                   " um is impossible here (allowed: " + format_number(kSmallestRadius) + " to " +
                   format_number(kLargestRadius) + "); is length_unit right?");
}

double celsius_of(const TomlTable& toml) {
  const double celsius = toml.number("temperature");
  if (celsius >= kColdest && celsius <= kHottest) return celsius;
  throw InputError(toml.where("temperature") + ": " + format_number(celsius) +
                   " degrees Celsius is impossible here (allowed: " + format_number(kColdest) +
                   " to " + format_number(kHottest) + ")");
}

struct Description {
  MeasuredVesicles data;
  fs::path table;
  double length = 1, time = 1, time_offset = 0;
  std::optional<double> radius;  // µm
  double sigmas = 1;             // standard deviations in what the table calls sigma
};

Description read_description(const fs::path& folder) {
  const TomlTable toml =
      TomlTable::read(folder / "dataset.toml",
                      {"name", "kind", "origin", "composition", "temperature", "time_zero",
                       "time_offset", "length_unit", "time_unit", "radius", "sigma", "table"});
  Description d;
  d.data.name = toml.text("name");
  const std::string kind = toml.text("kind");
  if (kind != "measured" && kind != "synthetic")
    throw InputError(toml.where("kind") + ": '" + kind + "' is neither measured nor synthetic");
  d.data.synthetic = kind == "synthetic";
  d.data.origin = toml.text_or("origin", "");
  d.data.composition = toml.text_or("composition", "");
  if (!d.data.composition.empty())
    (void)membrane_mixture(toml.where("composition"), d.data.composition);
  d.data.time_zero = toml.text("time_zero");
  if (toml.has("temperature")) d.data.celsius = celsius_of(toml);
  d.length = length_factor(toml, "length_unit");
  d.time = time_factor(toml, "time_unit");
  d.time_offset = toml.number_or("time_offset", 0);
  if (!std::isfinite(d.time_offset))
    throw InputError(toml.where("time_offset") + ": a finite number is needed here");
  if (toml.has("radius"))
    d.radius = checked_radius(toml.number("radius") * d.length, toml.where("radius"));
  const std::string sigma = toml.text_or("sigma", "standard deviation");
  if (sigma != "standard deviation" && sigma != "95 % interval")
    throw InputError(toml.where("sigma") + ": '" + sigma +
                     "' is neither 'standard deviation' nor '95 % interval' (its half length)");
  constexpr double kHalfLength95 = 1.959964;
  d.sigmas = sigma == "standard deviation" ? 1 : kHalfLength95;
  d.table = folder / toml.text_or("table", "measurements.csv");
  return d;
}

double in_range(const CsvTable& table, std::size_t row, const char* column, double low,
                double high) {
  const double value = table.number(row, column);
  if (value >= low && value <= high) return value;
  throw InputError(table.where(row, column) + ": " + format_number(value) +
                   " is impossible (allowed: " + format_number(low) + " to " + format_number(high) +
                   ")");
}

double radius_of(const Description& d, const CsvTable& table, std::size_t row) {
  if (!table.has("radius") && !d.radius)
    throw InputError(table.heading() +
                     ": there is no column 'radius', and dataset.toml has no radius for all");
  if (!table.has("radius")) return *d.radius;
  return checked_radius(table.number(row, "radius") * d.length, table.where(row, "radius"));
}

// Of vesicle, time and radius; the order of rows is checked against what is there already.
Measurement begin_measurement(const Description& d, const CsvTable& table, std::size_t row,
                              std::set<std::string>& finished) {
  const auto& before = d.data.measurements;
  Measurement m{table.text(row, "vesicle"), 0, radius_of(d, table, row), {}, {}};
  if (m.vesicle.empty()) throw InputError(table.where(row, "vesicle") + ": a name is needed here");
  m.time = table.number(row, "time") * d.time + d.time_offset * d.time;
  if (!(m.time >= 0))
    throw InputError(table.where(row, "time") + ": a time before time zero is impossible");
  if (m.time > kLatest)
    throw InputError(table.where(row, "time") + ": " + format_number(m.time) +
                     " s is impossible (allowed: to " + format_number(kLatest) +
                     " s); is time_unit right?");
  if (before.empty()) return m;
  if (before.back().vesicle != m.vesicle) finished.insert(before.back().vesicle);
  if (finished.count(m.vesicle))
    throw InputError(table.where(row, "vesicle") + ": vesicle '" + m.vesicle +
                     "' is there twice; keep its rows together, or give it another name");
  if (before.back().vesicle == m.vesicle && !(m.time > before.back().time))
    throw InputError(table.where(row, "time") + ": times of a vesicle have to ascend (before it: " +
                     format_number(before.back().time / d.time - d.time_offset) + ")");
  if (before.back().vesicle == m.vesicle &&
      std::max(m.radius, before.back().radius) >
          kSameRadius * std::min(m.radius, before.back().radius))
    throw InputError(table.where(row, "radius") + ": vesicle '" + m.vesicle + "' had a radius of " +
                     format_number(before.back().radius) + " um a look before, and has " +
                     format_number(m.radius) + " um now; are these two vesicles?");
  return m;
}

// Quantities of one look that exclude each other.
void refuse_contradictions(const CsvTable& table, std::size_t row, const Measurement& m) {
  const auto perimeter = m.of(Quantity::perimeter), rafts = m.of(Quantity::rafts),
             fraction = m.of(Quantity::fraction);
  for (const Quantity quantity : {Quantity::perimeter, Quantity::fraction})
    if (const auto value = m.of(quantity); rafts && value && (*rafts > 0) != (*value > 0))
      throw InputError(table.where(row, name_of(quantity).id) + ": " +
                       (*rafts > 0 ? "rafts have a boundary and an area"
                                   : "without rafts there is no boundary and no area"));
  if (!perimeter || !fraction) return;
  // The isoperimetric inequality on a sphere of radius 1: P² ≥ A (4π − A), with equality for caps.
  const double shortest = 4 * kPi * std::sqrt(*fraction * (1 - *fraction));
  if (*perimeter < kTooShort * shortest)
    throw InputError(table.where(row, "perimeter") + ": " + format_number(*perimeter * m.radius) +
                     " um is too short: the shortest boundary of a raft fraction of " +
                     format_number(*fraction) + " has " + format_number(shortest * m.radius) +
                     " um");
}

void read_value(const Description& d, const CsvTable& table, std::size_t row, Quantity quantity,
                Measurement& m) {
  const char* column = name_of(quantity).id;
  if (!table.has(column) || table.empty(row, column)) return;
  const double unit = quantity == Quantity::perimeter ? d.length / m.radius : 1;
  const double highest = quantity == Quantity::fraction    ? 1
                         : quantity == Quantity::perimeter ? kLargestPerimeter / unit
                                                           : kMostRafts;
  const double value = in_range(table, row, column, 0, highest);
  if (quantity == Quantity::rafts && value != std::floor(value))
    throw InputError(table.where(row, column) + ": a whole number is needed here");
  m.values[static_cast<std::size_t>(quantity)] = value * unit;
  const std::string sigma = std::string(column) + "_sigma";
  if (!table.has(sigma) || table.empty(row, sigma)) return;
  m.sigma[static_cast<std::size_t>(quantity)] =
      in_range(table, row, sigma.c_str(), 0, highest) * unit / d.sigmas;
}

void check_columns(const CsvTable& table, const std::vector<std::string>& known) {
  table.require("vesicle");
  table.require("time");
  for (const std::string& column : table.columns())
    if (std::find(known.begin(), known.end(), column) == known.end())
      throw InputError(table.heading() + ": " + unknown_name_message("column", column, known));
  for (const Quantity quantity : kQuantities) {
    const std::string name = name_of(quantity).id;
    if (table.has(name + "_sigma") && !table.has(name))
      throw InputError(table.heading() + ": there is a column '" + name + "_sigma', but none '" +
                       name + "'");
  }
}

// A row per look.
void read_totals(Description& d, const CsvTable& table) {
  check_columns(table, {"vesicle", "time", "radius", "perimeter", "perimeter_sigma", "rafts",
                        "rafts_sigma", "fraction", "fraction_sigma"});
  std::set<std::string> finished;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Measurement m = begin_measurement(d, table, row, finished);
    for (const Quantity quantity : kQuantities) read_value(d, table, row, quantity, m);
    if (!m.values[0] && !m.values[1] && !m.values[2])
      throw InputError(table.where(row) + ": nothing was measured (perimeter, rafts, fraction)");
    refuse_contradictions(table, row, m);
    d.data.measurements.push_back(m);
  }
}

// Of one raft. Nothing: the look has shown none.
std::optional<double> cap_of(const Description& d, const CsvTable& table, std::size_t row,
                             double radius) {
  if (table.empty(row, "cap_radius")) return std::nullopt;
  const double cap = in_range(table, row, "cap_radius", 0, radius / d.length) * d.length;
  if (cap > 0) return cap;
  throw InputError(table.where(row, "cap_radius") +
                   ": a raft has a size; leave the cell empty for a look that shows no raft");
}

// A row per raft, or one for a look without rafts; those of one look stand together.
void read_caps(Description& d, const CsvTable& table) {
  check_columns(table, {"vesicle", "time", "radius", "cap_radius"});
  std::set<std::string> finished;
  for (std::size_t row = 0; row < table.rows();) {
    Measurement m = begin_measurement(d, table, row, finished);
    std::vector<double> caps;
    const std::size_t first = row;
    for (; row < table.rows() && table.text(row, "vesicle") == m.vesicle &&
           table.number(row, "time") == table.number(first, "time");
         ++row) {
      if (radius_of(d, table, row) != m.radius)
        throw InputError(table.where(row, "radius") + ": one look at a vesicle, two radii");
      if (row > first && (table.empty(row, "cap_radius") || table.empty(first, "cap_radius")))
        throw InputError(table.where(row, "cap_radius") + ": a look without rafts has one row");
      if (const auto cap = cap_of(d, table, row, m.radius)) caps.push_back(*cap);
    }
    set_caps(m, caps);
    if (*m.of(Quantity::fraction) > 1)
      throw InputError(table.where(first) + ": these caps cover more than the whole vesicle");
    d.data.measurements.push_back(m);
  }
}

}  // namespace

MeasuredVesicles read_dataset(const fs::path& folder) {
  Description d = read_description(folder);
  if (!std::filesystem::exists(d.table))
    throw InputError(d.table.string() + ": there is no such table of measurements");
  const CsvTable table = CsvTable::read(d.table);
  if (table.has("cap_radius"))
    read_caps(d, table);
  else
    read_totals(d, table);
  if (d.data.measurements.empty()) throw InputError(d.table.string() + ": nothing was measured");
  return d.data;
}

void write_dataset(const fs::path& folder, const MeasuredVesicles& data,
                   const std::string& remark) {
  const auto quoted = [](const std::string& text) { return nlohmann::json(text).dump(); };
  std::string toml = "# " + remark + "\nname = " + quoted(data.name) +
                     "\nkind = " + (data.synthetic ? "\"synthetic\"" : "\"measured\"") +
                     "\norigin = " + quoted(data.origin) + "\n";
  if (!data.composition.empty()) toml += "composition = " + quoted(data.composition) + "\n";
  if (data.celsius) toml += "temperature = " + format_number(*data.celsius) + "  # C\n";
  toml += "time_zero = " + quoted(data.time_zero) + "\nlength_unit = \"um\"\ntime_unit = \"s\"\n";
  std::string csv = "# " + remark +
                    "\nvesicle,time,radius,perimeter,perimeter_sigma,rafts,rafts_sigma,fraction,"
                    "fraction_sigma\n";
  for (const Measurement& m : data.measurements) {
    csv += csv_cell(m.vesicle) + "," + format_number(m.time) + "," + format_number(m.radius);
    for (const Quantity quantity : kQuantities) {
      const double unit = quantity == Quantity::perimeter ? m.radius : 1;
      for (const auto& value : {m.of(quantity), m.sigma[static_cast<std::size_t>(quantity)]})
        csv += "," + (value ? format_number(*value * unit) : "");
    }
    csv += "\n";
  }
  fs::create_directories(folder);
  write_durably(folder / "measurements.csv", csv);
  write_durably(folder / "dataset.toml", toml);
}

}  // namespace traceraft
