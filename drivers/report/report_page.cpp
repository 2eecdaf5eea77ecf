#include "drivers/report/report_page.hpp"

#include <algorithm>
#include <cmath>

#include "backends/posix/own_files.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/data/measured_report.hpp"
#include "drivers/ensemble/ensemble_report.hpp"
#include "drivers/ensemble/histories_file.hpp"
#include "drivers/input/csv_table.hpp"
#include "drivers/input/json_file.hpp"
#include "drivers/input/model_of_data.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/page.hpp"
#include "drivers/output/provenance.hpp"
#include "drivers/output/text_table.hpp"
#include "drivers/report/viewer.hpp"
#include "drivers/run/finished_run.hpp"
#include "drivers/run/physical_model.hpp"
#include "drivers/run/run_numbers.hpp"
#include "drivers/text/unit_names.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::report {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLargestPage = std::uint64_t{1} << 30;

bool is_run(const fs::path& folder) {
  return fs::exists(folder / "config.toml") && fs::exists(folder / "series.csv");
}

bool is_ensemble(const fs::path& folder) {
  return ensemble::EnsembleFolder(folder).started() && fs::exists(folder / "runs") &&
         !fs::exists(folder / "compare.csv");
}

bool keeps_histories(const fs::path& folder) {
  return fs::exists(folder / "config.toml") && fs::exists(folder / ensemble::kHistoriesFile);
}

// The page that another command has written, "" if there is none.
std::string finished_page(const fs::path& folder) {
  std::vector<const char*> names{"verify.html", "compare.html", "calibration.html", "explain.html",
                                 "series.html"};
  if (!is_run(folder) && !is_ensemble(folder)) names.push_back("comparison.html");
  for (const char* name : names)
    if (fs::exists(folder / name)) return posix::read_file(folder / name, kLargestPage);
  return "";
}

struct Curve {
  std::string column, title;
  bool log_y;
  std::optional<observations::Quantity> measured = {};
};

std::vector<Curve> curves() {
  return {{"perimeter", "perimeter", true, observations::Quantity::perimeter},
          {"rafts", "number of rafts", true, observations::Quantity::rafts},
          {"raft_fraction", "raft area fraction", false, observations::Quantity::fraction},
          {"energy", "energy", false},
          {"dt", "step size", true}};
}

bench::Chart series_chart(const input::CsvTable& series, const Curve& curve, bool scaled) {
  const std::string unit = run::unit_of_number(curve.column, scaled);
  const std::string label = curve.title + (unit.empty() ? "" : " (" + unit + ")");
  const std::string time = "time (" + run::unit_of_number("t", scaled) + ")";
  bench::Chart chart{curve.title, time, label, true, curve.log_y, {}};
  chart.series = {{curve.column, {}, bench::Mark::line}};
  const std::vector<double> t = series.numbers("t"), y = series.numbers(curve.column);
  for (std::size_t i = 0; i < t.size(); ++i)
    if (t[i] > 0 && (y[i] > 0 || !curve.log_y)) chart.series[0].points.emplace_back(t[i], y[i]);
  return chart;
}

void add_surface(output::Page& page, const fs::path& run, const PageRequest& request,
                 output::Missing& missing) {
  if (!fs::exists(run / "fields.pvd")) return missing.add("the run wrote no fields");
  page.heading("The surface");
  const auto [low, high] = phases_of(run);
  const SurfaceFrames frames = read_frames(run, request.detail, request.frames);
  const View view{time_labels(run, frames.times), low, high, frames.frames.size() - 1};
  missing.add(add_viewer(page, frames.meshes, frames.frames, view));
}

std::string value_text(const input::Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_number_float() ? formatted("%.6g", value.get<double>()) : value.dump();
}

void add_summary(output::Page& page, const fs::path& run, bool scaled) {
  if (!fs::exists(run / "summary.json")) return;
  std::vector<output::Row> rows = {{"number", "value", "unit"}};
  input::from_json(run / "summary.json", [&](const input::Json& json) {
    for (const auto& [key, value] : json.items()) {
      if (!value.is_object())
        rows.push_back({key, value_text(value), run::unit_of_number(key, scaled)});
      if (value.is_object())
        for (const auto& [inner, entry] : value.items())
          rows.push_back({key + "." + inner, value_text(entry), ""});
    }
    return 0;
  });
  page.heading("Numbers");
  page.table(rows);
}

void fill_run(output::Page& page, const fs::path& folder, const PageRequest& request,
              output::Missing& missing) {
  run::require_whole_tables(folder);
  const config::Configuration configuration(config::read_config_file(folder / "config.toml"), {});
  run::require_own_configuration(folder, configuration);
  const bool scaled = configuration.units().scaled;
  page.paragraph("A run of the case " + configuration.options().case_name + ", seed " +
                 std::to_string(configuration.options().seed) + ".");
  add_surface(page, folder, request, missing);
  page.heading("In time");
  if (request.data) page.paragraph("Measured perimeters are scaled to the radius of this vesicle.");
  const input::CsvTable series = input::CsvTable::read(folder / "series.csv");
  for (const Curve& curve : curves()) {
    bench::Chart chart = series_chart(series, curve, scaled);
    if (request.data && curve.measured) {
      const double unit =
          *curve.measured == observations::Quantity::perimeter ? configuration.units().length() : 1;
      chart.series.push_back(data::measured_points(*request.data, *curve.measured, unit));
    }
    output::add_chart(page, chart, request.charts / curve.column, missing);
  }
  add_summary(page, folder, scaled);
  output::add_settings(page, configuration);
  output::add_provenance(page, folder, output::command_for("traceraft run", configuration));
}

// The comparison that `data compare` has left, as it is, and whether it is of the same runs.
void add_comparison(output::Page& page, const fs::path& folder, std::size_t runs) {
  if (!fs::exists(folder / "comparison.html") || !fs::exists(folder / "comparison.json")) return;
  page.heading("Compared with measurements");
  const auto compared = input::from_json(folder / "comparison.json", [](const input::Json& json) {
    return json.at("runs").get<std::size_t>();
  });
  if (compared != runs)
    page.paragraph(
        formatted("OUT OF DATE: this comparison used %zu runs, and there are %zu now. Repeat "
                  "traceraft data compare.",
                  compared, runs));
  page.raw(output::page_body(posix::read_file(folder / "comparison.html", kLargestPage)));
}

// `physical`: in s, rather than in units of R²/D.
void add_all_runs(output::Page& page, const std::vector<observations::History>& runs, bool physical,
                  const PageRequest& request, output::Missing& missing) {
  const ensemble::EnsembleSummary summary = ensemble::summarise(runs);
  page.heading("All runs");
  for (const observations::Quantity quantity : observations::kQuantities) {
    bench::Chart chart = ensemble::ensemble_chart(summary, quantity, physical);
    if (request.data) chart.series.push_back(data::measured_points(*request.data, quantity));
    output::add_chart(page, chart, request.charts / observations::name_of(quantity).id, missing);
  }
  page.heading("Numbers");
  page.table(ensemble::ensemble_rows(summary, physical));
}

// The page of a kept ensemble, which has no fields to show.
void fill_kept(output::Page& page, const fs::path& path, const PageRequest& request,
               output::Missing& missing) {
  const config::Configuration configuration = data::model_of(path);
  const std::vector<observations::History> runs = data::runs_of(path).histories;
  page.paragraph(formatted("Kept histories of %zu runs of the case ", runs.size()) +
                 configuration.options().case_name + ".");
  add_all_runs(page, runs, true, request, missing);
  output::add_settings(page, configuration);
  const std::string first = input::CsvTable::read(path / ensemble::kHistoriesFile).text(0, "seed");
  output::add_provenance(
      page, path,
      output::command_for(formatted("traceraft ensemble --runs %zu", runs.size()) +
                              (first == "1" ? "" : " --first-seed " + first),
                          configuration));
}

void fill_ensemble(output::Page& page, const fs::path& path, const PageRequest& request,
                   output::Missing& missing) {
  const ensemble::EnsembleFolder folder(path);
  const config::Configuration configuration(config::read_config_file(folder.config()), {});
  const physics::Units units = configuration.units();
  const ensemble::FinishedMembers finished = ensemble::finished_members(folder, configuration);
  const std::vector<observations::History>& runs = finished.histories;
  if (runs.empty()) throw InputError(path.string() + ": no run of this ensemble has finished");
  const fs::path shown = folder.run_of(finished.seeds.front());
  const ensemble::EnsemblePlan plan = folder.load();
  page.paragraph(formatted("%zu of %d runs of the case ", runs.size(), plan.runs) +
                 configuration.options().case_name + ", seeds " + std::to_string(plan.first_seed) +
                 " to " + std::to_string(plan.last_seed()) + ". The surface is that of " +
                 shown.filename().string() + ".");
  for (const ensemble::MemberFailure& failure : finished.damaged)
    page.paragraph("The run of seed " + std::to_string(failure.seed) +
                   " is left out: " + failure.why);
  add_surface(page, shown, request, missing);
  add_all_runs(page, runs, !units.scaled, request, missing);
  add_comparison(page, path, runs.size());
  ensemble::add_ensemble_origin(page, folder, configuration);
}

void introduce(const observations::MeasuredVesicles& data, const fs::path& folder,
               output::Page& page) {
  const config::Configuration model(config::read_config_file(folder / "config.toml"), {});
  if (model.units().scaled)
    throw InputError("--data: times of " + folder.string() + " are in units of R^2/D, not in s");
  page.paragraph("Measurements: " + data::about_data(data) + ".");
  if (const std::string other = input::other_membrane(data.composition, model); !other.empty())
    page.paragraph("ANOTHER MEMBRANE: the simulated membrane is " + other + ".");
}

}  // namespace

fs::path run_to_show(const fs::path& path) {
  if (is_run(path)) return path;
  if (is_ensemble(path)) {
    const ensemble::EnsembleFolder folder(path);
    for (const std::uint64_t seed : folder.load().seeds())
      if (folder.member(seed).end == ensemble::MemberEnd::finished) return folder.run_of(seed);
  }
  throw InputError(path.string() + " holds no finished run to show");
}

std::vector<std::string> time_labels(const fs::path& run_folder, const std::vector<double>& times) {
  const config::Configuration model(config::read_config_file(run_folder / "config.toml"), {});
  const std::string unit = text::unit_name(text::Unit::time, model.units().scaled);
  std::vector<std::string> labels;
  for (const double t : times) labels.push_back(formatted("t = %.4g ", t) + unit);
  return labels;
}

std::pair<double, double> phases_of(const fs::path& run_folder) {
  const physics::DoubleWell well = run::double_well(
      config::Configuration(config::read_config_file(run_folder / "config.toml"), {}));
  return {well.a, well.b};
}

std::string write_report_page(const fs::path& folder, const fs::path& out,
                              const PageRequest& request) {
  const auto make_folder = [](const fs::path& path) {
    if (!path.empty()) fs::create_directories(path);
  };
  if (const std::string page = finished_page(folder); !page.empty()) {
    if (request.data)
      throw InputError(
          "--data: the page of " + folder.string() +
          " is already written; measurements can be shown with runs and ensembles only");
    make_folder(out.parent_path());
    posix::write_durably(out, page);
    return "";
  }
  const bool kept = !is_run(folder) && !is_ensemble(folder) && keeps_histories(folder);
  if (!is_run(folder) && !is_ensemble(folder) && !kept)
    throw InputError(
        folder.string() +
        " holds no results of traceraft: no run, ensemble, comparison or verification");
  output::Page page("traceraft: " + fs::absolute(folder).lexically_normal().filename().string());
  if (request.data) introduce(*request.data, folder, page);
  make_folder(out.parent_path());
  posix::make_inner_folder(request.charts);
  output::Missing missing;
  if (is_run(folder))
    fill_run(page, folder, request, missing);
  else if (kept)
    fill_kept(page, folder, request, missing);
  else
    fill_ensemble(page, folder, request, missing);
  posix::write_durably(out, page.html());
  return missing.text();
}

}  // namespace traceraft::report
