#include "drivers/input/measurement_rows.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "drivers/input/measured_units.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/types.hpp"

namespace traceraft::input {
namespace {

constexpr double kLargestPerimeter = 1000;  // over the radius
constexpr double kMostRafts = 1e6;
// The largest ratio of the radii of one vesicle between looks, and the smallest of a perimeter to
// the shortest one of its area. Both are read off images.
constexpr double kSameRadius = 1.2, kTooShort = 0.5;

double in_range(const CsvTable& table, std::size_t row, const char* column, double low,
                double high) {
  const double value = table.number(row, column);
  constexpr double kRoundoff = 1e-12;  // of changes of unit
  if (value >= low && value <= (1 + kRoundoff) * high) return std::min(value, high);
  throw InputError(table.where(row, column) + ": " + format_number(value) +
                   " is impossible (allowed: " + format_number(low) + " to " + format_number(high) +
                   ")");
}

double radius_of(const TableUnits& units, const CsvTable& table, std::size_t row) {
  if (!table.has("radius") && !units.radius)
    throw InputError(table.heading() +
                     ": there is no column 'radius', and dataset.toml has no radius for all");
  if (!table.has("radius")) return *units.radius;
  return checked_radius(table.number(row, "radius") * units.length, table.where(row, "radius"));
}

// A measurement with vesicle, time and radius. The order of rows is checked against what is there
// already.
observations::Measurement begin_measurement(const TableUnits& units, const CsvTable& table,
                                            std::size_t row,
                                            const std::vector<observations::Measurement>& before,
                                            std::set<std::string>& finished) {
  observations::Measurement m{table.text(row, "vesicle"), 0, radius_of(units, table, row), {}, {}};
  if (m.vesicle.empty()) throw InputError(table.where(row, "vesicle") + ": a name is needed here");
  m.time = checked_time((table.number(row, "time") + units.time_offset) * units.time,
                        table.where(row, "time"));
  if (before.empty()) return m;
  if (before.back().vesicle != m.vesicle) finished.insert(before.back().vesicle);
  if (finished.count(m.vesicle))
    throw InputError(table.where(row, "vesicle") + ": vesicle '" + m.vesicle +
                     "' occurs twice; keep its rows together, or use another name");
  if (before.back().vesicle == m.vesicle && !(m.time > before.back().time))
    throw InputError(table.where(row, "time") +
                     ": times of a vesicle must ascend (the time before is " +
                     format_number(before.back().time / units.time - units.time_offset) + ")");
  if (before.back().vesicle == m.vesicle &&
      std::max(m.radius, before.back().radius) >
          kSameRadius * std::min(m.radius, before.back().radius))
    throw InputError(table.where(row, "radius") + ": vesicle '" + m.vesicle + "' had a radius of " +
                     format_number(before.back().radius) +
                     " um at the observation before, and has " + format_number(m.radius) +
                     " um now. Are these two vesicles?");
  return m;
}

// Quantities of one look that exclude each other.
void refuse_contradictions(const CsvTable& table, std::size_t row,
                           const observations::Measurement& m) {
  const auto perimeter = m.of(observations::Quantity::perimeter),
             rafts = m.of(observations::Quantity::rafts),
             fraction = m.of(observations::Quantity::fraction);
  for (const observations::Quantity quantity :
       {observations::Quantity::perimeter, observations::Quantity::fraction})
    if (const auto value = m.of(quantity); rafts && value && (*rafts > 0) != (*value > 0))
      throw InputError(table.where(row, observations::name_of(quantity).id) + ": " +
                       (*rafts > 0 ? "rafts have a boundary and an area"
                                   : "without rafts there is no boundary and no area"));
  if (!perimeter || !fraction) return;
  if (*perimeter > 0 && *fraction == 0)
    throw InputError(table.where(row, "fraction") + ": rafts have a boundary and an area");
  // The isoperimetric inequality on a sphere of radius 1: P² ≥ A (4π − A), with equality for caps.
  const double shortest = 4 * kPi * std::sqrt(*fraction * (1 - *fraction));
  if (*perimeter < kTooShort * shortest)
    throw InputError(table.where(row, "perimeter") + ": " + format_number(*perimeter * m.radius) +
                     " um is too short: the shortest boundary of a raft fraction of " +
                     format_number(*fraction) + " has " + format_number(shortest * m.radius) +
                     " um; was it divided by the radius already?");
}

// The column `name`_sigma as a standard deviation, in the unit of the table; nothing if the cell is
// empty.
std::optional<double> sigma_in(const TableUnits& units, const CsvTable& table, std::size_t row,
                               const std::string& name, double highest) {
  const std::string column = name + "_sigma";
  if (!table.has(column) || table.empty(row, column)) return std::nullopt;
  return in_range(table, row, column.c_str(), 0, highest) / units.sigmas;
}

void read_value(const TableUnits& units, const CsvTable& table, std::size_t row,
                observations::Quantity quantity, observations::Measurement& m) {
  const char* column = observations::name_of(quantity).id;
  if (!table.has(column) || table.empty(row, column)) return;
  const double unit = quantity == observations::Quantity::perimeter ? units.length / m.radius : 1;
  const double highest = quantity == observations::Quantity::fraction    ? 1
                         : quantity == observations::Quantity::perimeter ? kLargestPerimeter / unit
                                                                         : kMostRafts;
  const double value = in_range(table, row, column, 0, highest);
  if (quantity == observations::Quantity::rafts && value != std::floor(value))
    throw InputError(table.where(row, column) + ": a whole number is needed here");
  m.values[observations::index_of(quantity)] = value * unit;
  if (const auto sigma = sigma_in(units, table, row, column, highest))
    m.sigma[observations::index_of(quantity)] = *sigma * unit;
}

void check_columns(const CsvTable& table, const std::vector<std::string>& known) {
  for (const std::string& column : table.columns())
    if (std::find(known.begin(), known.end(), column) == known.end())
      throw InputError(table.heading() + ": " + unknown_name_message("column", column, known));
  table.require("vesicle");
  table.require("time");
  for (const observations::Quantity quantity : observations::kQuantities) {
    const std::string name = observations::name_of(quantity).id;
    if (table.has(name + "_sigma") && !table.has(name))
      throw InputError(table.heading() + ": there is a column '" + name + "_sigma', but none '" +
                       name + "'");
  }
}

// A row per look.
std::vector<observations::Measurement> read_totals(const TableUnits& units, const CsvTable& table) {
  check_columns(table, {"vesicle", "time", "radius", "perimeter", "perimeter_sigma", "rafts",
                        "rafts_sigma", "fraction", "fraction_sigma"});
  std::vector<observations::Measurement> looks;
  std::set<std::string> finished;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    observations::Measurement m = begin_measurement(units, table, row, looks, finished);
    for (const observations::Quantity quantity : observations::kQuantities)
      read_value(units, table, row, quantity, m);
    if (!m.values[0] && !m.values[1] && !m.values[2])
      throw InputError(table.where(row) + ": nothing was measured (perimeter, rafts, fraction)");
    refuse_contradictions(table, row, m);
    looks.push_back(m);
  }
  return looks;
}

// The cap of one raft. Nothing: the look has shown none.
std::optional<observations::Cap> cap_of(const TableUnits& units, const CsvTable& table,
                                        std::size_t row, double radius) {
  if (table.empty(row, "cap_radius")) return std::nullopt;
  const double largest = radius / units.length;
  observations::Cap cap{in_range(table, row, "cap_radius", 0, largest) * units.length,
                        std::nullopt};
  if (const auto sigma = sigma_in(units, table, row, "cap_radius", largest))
    cap.sigma = *sigma * units.length;
  if (cap.base_radius > 0) return cap;
  throw InputError(table.where(row, "cap_radius") +
                   ": a raft has a size; leave the cell empty for an observation without rafts");
}

// A row per raft, or one for a look without rafts; those of one look stand together.
std::vector<observations::Measurement> read_caps(const TableUnits& units, const CsvTable& table) {
  check_columns(table, {"vesicle", "time", "radius", "cap_radius", "cap_radius_sigma"});
  std::vector<observations::Measurement> looks;
  std::set<std::string> finished;
  for (std::size_t row = 0; row < table.rows();) {
    observations::Measurement m = begin_measurement(units, table, row, looks, finished);
    std::vector<observations::Cap> caps;
    const std::size_t first = row;
    for (; row < table.rows() && table.text(row, "vesicle") == m.vesicle &&
           table.number(row, "time") == table.number(first, "time");
         ++row) {
      if (radius_of(units, table, row) != m.radius)
        throw InputError(table.where(row, "radius") +
                         ": one observation of a vesicle has two radii");
      if (row > first && (table.empty(row, "cap_radius") || table.empty(first, "cap_radius")))
        throw InputError(table.where(row, "cap_radius") +
                         ": an observation without rafts has one row");
      const auto cap = cap_of(units, table, row, m.radius);
      if (cap && !caps.empty() && cap->sigma.has_value() != caps.front().sigma.has_value())
        throw InputError(table.where(row, "cap_radius_sigma") +
                         ": within one observation, all rafts or none must have a sigma");
      if (cap) caps.push_back(*cap);
    }
    observations::set_caps(m, caps);
    if (*m.of(observations::Quantity::fraction) > 1)
      throw InputError(table.where(first, "cap_radius") +
                       ": the caps of this observation cover more than the whole vesicle");
    looks.push_back(m);
  }
  return looks;
}

}  // namespace

std::vector<observations::Measurement> read_measurements(const TableUnits& units,
                                                         const CsvTable& table) {
  return table.has("cap_radius") ? read_caps(units, table) : read_totals(units, table);
}

}  // namespace traceraft::input
