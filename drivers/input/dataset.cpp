#include "drivers/input/dataset.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "backends/posix/durable_file.hpp"
#include "drivers/config/toml_table.hpp"
#include "drivers/input/measured_folder.hpp"
#include "drivers/input/measured_units.hpp"
#include "drivers/input/measurement_rows.hpp"
#include "drivers/text/csv.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft::input {
namespace {

namespace fs = std::filesystem;

struct Dataset {
  observations::MeasuredVesicles data;
  fs::path table;
  TableUnits units;
  std::string where_radius;  // it says one for all vesicles
};

Dataset read_description(const fs::path& folder) {
  if (holds_fields(folder) && !holds_series(folder))
    throw InputError(folder.string() + " holds measured fields, not series of vesicles");
  const config::TomlTable toml = read_series_description(folder);
  Dataset d;
  d.data.name = toml.text("name");
  d.data.synthetic = is_synthetic(toml);
  d.data.origin = toml.text_or("origin", "");
  d.data.composition = composition_of(toml);
  d.data.time_zero = toml.text("time_zero");
  d.data.celsius = celsius_of(toml);
  d.units.length = length_factor(toml, "length_unit");
  d.units.time = time_factor(toml, "time_unit");
  d.units.time_offset = time_offset(toml);
  d.data.time_unit = d.units.time;
  d.data.time_offset = d.units.time_offset;
  d.where_radius = toml.where("radius");
  if (toml.has("radius"))
    d.units.radius = checked_radius(toml.number("radius") * d.units.length, toml.where("radius"));
  const std::string sigma = toml.text_or("sigma", "standard deviation");
  if (sigma != "standard deviation" && sigma != "95 % interval" && sigma != "95% interval")
    throw InputError(toml.where("sigma") + ": '" + sigma +
                     "' is neither 'standard deviation' nor '95 % interval' (its half length)");
  constexpr double kHalfLength95 = 1.959964;
  d.units.sigmas = sigma == "standard deviation" ? 1 : kHalfLength95;
  d.table = folder / toml.text_or("table", "measurements.csv");
  return d;
}

}  // namespace

observations::MeasuredVesicles read_dataset(const fs::path& folder) {
  Dataset d = read_description(folder);
  if (!std::filesystem::is_regular_file(d.table))
    throw InputError(d.table.string() + ": the table of measurements does not exist");
  const CsvTable table = CsvTable::read(d.table);
  // Fields in the same folder are of one radius, which says nothing of the vesicles of a table.
  if (d.units.radius && table.has("radius") && !holds_fields(folder))
    throw InputError(d.where_radius + ": " + d.table.string() +
                     " has a column 'radius'; leave one of the two out");
  d.data.measurements = read_measurements(d.units, table);
  if (d.data.measurements.empty()) throw InputError(d.table.string() + ": nothing was measured");
  return d.data;
}

void write_dataset(const fs::path& folder, const observations::MeasuredVesicles& data,
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
  for (const observations::Measurement& m : data.measurements) {
    csv += text::csv_cell(m.vesicle) + "," + format_number(m.time) + "," + format_number(m.radius);
    for (const observations::Quantity quantity : observations::kQuantities) {
      const double unit = quantity == observations::Quantity::perimeter ? m.radius : 1;
      for (const auto& value : {m.of(quantity), m.sigma[observations::index_of(quantity)]})
        csv += "," + (value ? format_number(*value * unit) : "");
    }
    csv += "\n";
  }
  fs::create_directories(folder);
  posix::write_durably(folder / "measurements.csv", csv);
  posix::write_durably(folder / "dataset.toml", toml);
}

}  // namespace traceraft::input
