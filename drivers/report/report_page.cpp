#include "drivers/report/report_page.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/config/config_file.hpp"
#include "drivers/ensemble/ensemble_report.hpp"
#include "drivers/input/csv_table.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/json_file.hpp"
#include "drivers/output/page.hpp"
#include "drivers/output/text_table.hpp"
#include "drivers/report/viewer.hpp"
#include "drivers/run/run_setup.hpp"
#include "drivers/version.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLargestPage = std::uint64_t{1} << 30;

bool is_run(const fs::path& folder) {
  return fs::exists(folder / "config.toml") && fs::exists(folder / "series.csv");
}

bool is_ensemble(const fs::path& folder) {
  return EnsembleFolder(folder).started() && fs::exists(folder / "runs") &&
         !fs::exists(folder / "compare.csv");
}

// The page that another command has written, "" if there is none.
std::string finished_page(const fs::path& folder) {
  std::vector<const char*> names{"verify.html", "compare.html"};
  if (!is_run(folder) && !is_ensemble(folder)) names.push_back("comparison.html");
  for (const char* name : names)
    if (fs::exists(folder / name)) return read_file(folder / name, kLargestPage);
  return "";
}

struct Curve {
  const char *column, *title;
  bool log_y;
};
constexpr Curve kCurves[] = {{"perimeter", "perimeter", true},
                             {"rafts", "number of rafts", true},
                             {"raft_fraction", "raft area fraction", false},
                             {"energy", "energy", false},
                             {"dt", "step size", true}};

Chart series_chart(const CsvTable& series, const Curve& curve, const std::string& time_unit) {
  Chart chart{curve.title, "time (" + time_unit + ")", curve.title, true, curve.log_y, {}};
  chart.series = {{curve.column, {}, Mark::line}};
  for (std::size_t row = 0; row < series.rows(); ++row) {
    const double t = series.number(row, "t"), y = series.number(row, curve.column);
    if (t > 0 && (y > 0 || !curve.log_y)) chart.series[0].points.emplace_back(t, y);
  }
  return chart;
}

void add_surface(Page& page, const fs::path& run, const PageRequest& request,
                 const std::string& time_unit, Missing& missing) {
  if (!fs::exists(run / "fields.pvd")) return missing.add("the run has written no fields");
  page.heading("The surface");
  const auto [low, high] = phases_of(run);
  const SurfaceFrames frames = read_frames(run, request.detail, request.frames);
  View view{{}, low, high, frames.values.size() - 1};
  for (const double t : frames.times) view.labels.push_back(formatted("t = %.4g ", t) + time_unit);
  missing.add(add_viewer(page, frames.mesh, frames.values, view));
}

void add_summary(Page& page, const fs::path& run) {
  if (!fs::exists(run / "summary.json")) return;
  std::vector<Row> rows = {{"number", "value"}};
  from_json(run / "summary.json", [&](const Json& json) {
    for (const auto& [key, value] : json.items())
      rows.push_back({key, value.is_string() ? value.get<std::string>() : value.dump()});
    return 0;
  });
  page.heading("Numbers");
  page.table(rows);
}

void add_settings(Page& page, const Configuration& configuration) {
  std::vector<Row> rows = {{"setting", "value", "meaning"}};
  for (const OptionSpec& spec : run_options())
    rows.push_back({spec.name, configuration.text(spec.name), spec.help});
  page.heading("Settings");
  page.table(rows);
}

// `command` and the flags repeat what the page shows.
void add_provenance(Page& page, const fs::path& folder, const std::string& command,
                    const Configuration& configuration) {
  page.heading("Where this comes from");
  page.paragraph("traceraft " + std::string(kVersion) + ", from the files in " +
                 fs::absolute(folder).lexically_normal().string() + ". To repeat it:");
  const std::string flags = flags_text(configuration);
  page.code(command + (flags.empty() ? "" : " ") + flags);
}

void fill_run(Page& page, const fs::path& folder, const PageRequest& request, Missing& missing) {
  const Configuration configuration(read_config_file(folder / "config.toml"), {});
  const std::string unit = configuration.units().scaled ? "R^2/D" : "s";
  page.paragraph("A run of the case " + configuration.text("case") + ", seed " +
                 configuration.text("seed") + ".");
  add_surface(page, folder, request, unit, missing);
  page.heading("In time");
  const CsvTable series = CsvTable::read(folder / "series.csv");
  for (const Curve& curve : kCurves)
    add_chart(page, series_chart(series, curve, unit),
              request.charts / ("report-" + std::string(curve.column)), missing);
  add_summary(page, folder);
  add_settings(page, configuration);
  add_provenance(page, folder, "traceraft run", configuration);
}

// What `data compare` has left.
void add_agreement(Page& page, const CsvTable& table) {
  std::vector<Row> rows = {table.columns()};
  for (std::size_t row = 0; row < table.rows(); ++row) {
    rows.emplace_back();
    for (const std::string& column : table.columns())
      rows.back().push_back(column == "quantity" ? table.text(row, column)
                                                 : short_number(table.number(row, column)));
  }
  page.paragraph("Compared with measurements:");
  page.table(rows);
}

void fill_ensemble(Page& page, const fs::path& path, const PageRequest& request, Missing& missing) {
  const EnsembleFolder folder(path);
  const Configuration configuration(read_config_file(folder.config()), {});
  const Units units = configuration.units();
  const std::vector<History> runs = finished_histories(folder, folder.load(), units.length());
  if (runs.empty()) throw InputError(path.string() + ": no run of this ensemble has finished");
  const fs::path shown = run_to_show(path);
  const EnsemblePlan plan = folder.load();
  page.paragraph(formatted("%zu of %d runs of the case ", runs.size(), plan.runs) +
                 configuration.text("case") + ", seeds " + std::to_string(plan.first_seed) +
                 " to " + std::to_string(plan.last_seed()) + ". Shown is " +
                 shown.filename().string() + ".");
  add_surface(page, shown, request, units.scaled ? "R^2/D" : "s", missing);
  page.heading("All runs");
  const EnsembleSummary summary = summarise(runs);
  for (const Quantity quantity : kQuantities)
    add_chart(page, ensemble_chart(summary, quantity, !units.scaled),
              request.charts / (std::string("report-") + name_of(quantity).id), missing);
  for (const Quantity quantity : kQuantities)
    if (const fs::path chart = path / (std::string("comparison-") + name_of(quantity).id + ".svg");
        fs::exists(chart)) {
      const std::string svg = read_file(chart, kLargestPage);
      page.figure(svg.substr(svg.find("<svg")),
                  std::string(name_of(quantity).label) + ", compared with measurements");
    }
  page.heading("Numbers");
  page.table(ensemble_rows(summary, !units.scaled));
  if (const fs::path agreement = path / "comparison.csv"; fs::exists(agreement))
    add_agreement(page, CsvTable::read(agreement));
  add_settings(page, configuration);
  add_provenance(page, path,
                 formatted("traceraft ensemble --runs %d --first-seed ", plan.runs) +
                     std::to_string(plan.first_seed),
                 configuration);
}

}  // namespace

fs::path run_to_show(const fs::path& path) {
  if (is_run(path)) return path;
  if (is_ensemble(path)) {
    const EnsembleFolder folder(path);
    for (const std::uint64_t seed : folder.load().seeds())
      if (folder.member(seed).end == MemberEnd::finished) return folder.run_of(seed);
  }
  throw InputError(path.string() + " holds no run that could be shown");
}

std::pair<double, double> phases_of(const fs::path& run_folder) {
  const DoubleWell well =
      double_well(Configuration(read_config_file(run_folder / "config.toml"), {}));
  return {well.a, well.b};
}

std::string write_report_page(const fs::path& folder, const fs::path& out,
                              const PageRequest& request) {
  if (const std::string page = finished_page(folder); !page.empty()) {
    write_durably(out, page);
    return "";
  }
  Page page("traceraft: " + fs::absolute(folder).lexically_normal().filename().string());
  Missing missing;
  if (is_run(folder))
    fill_run(page, folder, request, missing);
  else if (is_ensemble(folder))
    fill_ensemble(page, folder, request, missing);
  else
    throw InputError(folder.string() +
                     " holds no run, ensemble, comparison or verification of traceraft");
  write_durably(out, page.html());
  return missing.text();
}

}  // namespace traceraft
