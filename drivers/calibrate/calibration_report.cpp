#include "drivers/calibrate/calibration_report.hpp"

#include <cmath>

#include "backends/posix/durable_file.hpp"
#include "drivers/calibrate/calibration_notes.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/data/agreement_report.hpp"
#include "drivers/data/measured_report.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/page.hpp"
#include "drivers/output/provenance.hpp"
#include "drivers/output/text_table.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::calibrate {
namespace {

// Between the end of a search and itself there is no interval.
std::vector<output::Row> rows_of(const std::vector<CalibrationFinding>& parameters,
                                 bool mobility_at_end) {
  std::vector<output::Row> rows = {
      {"parameter", "value", "95 % interval", "unit", "determined by the data"}};
  for (const CalibrationFinding& found : parameters)
    rows.push_back({found.name, formatted("%.3g", found.value),
                    mobility_at_end && found.name == "mobility"
                        ? "at the end of the range searched"
                        : formatted("%.3g to %.3g", found.low, found.high),
                    found.unit, found.determined() ? "yes" : "NO: " + joined(found.open, "; ")});
  return rows;
}

bench::Table points_table(const CalibrationRuns& runs, const calibration::Calibration& result) {
  const std::vector<calibration::CalibrationPoint>& points = runs.points;
  bench::Table table{"calibration", runs.names, {}};
  for (const char* column : {"mobility", "scatter", "deviance", "runs"})
    table.columns.push_back(column);
  for (std::size_t k = 0; k < points.size(); ++k) {
    std::vector<bench::Cell> row;
    for (const double ln : points[k].ln_parameters) row.emplace_back(std::exp(ln));
    const likelihood::EnsembleFit& fit = result.at_points[k];
    row.emplace_back(diffusion(runs.model, fit.seconds_per_unit()));
    row.emplace_back(fit.scatter_beyond_runs(observations::Quantity::perimeter));
    row.emplace_back(fit.deviance);
    row.emplace_back(static_cast<double>(points[k].runs.size()));
    table.rows.push_back(row);
  }
  return table;
}

// The measurements in the runs that fit best.
void add_fit(output::Page& page, const std::filesystem::path& folder,
             const observations::MeasuredVesicles& data,
             const std::vector<observations::History>& best, output::Missing& missing) {
  const ensemble::EnsembleSummary summary = ensemble::summarise(best);
  for (const observations::Quantity quantity :
       {observations::Quantity::perimeter, observations::Quantity::rafts}) {
    bench::Chart chart = data::comparison_chart(data, summary, quantity);
    chart.title += " and the simulations that fit best";
    output::add_chart(page, chart,
                      folder / (std::string("fit-") + observations::name_of(quantity).id), missing);
  }
}

// Within what counts of the best: what is further away only flattens the rest.
void add_deviances(output::Page& page, const std::filesystem::path& folder,
                   const CalibrationRuns& runs, const calibration::Calibration& result,
                   output::Missing& missing) {
  constexpr double kShown = 50, kExcluded = 3.84;
  for (std::size_t i = 0; i < runs.names.size(); ++i) {
    const calibration::CalibratedParameter& found = result.parameters[i + 1];
    const double best = result.best.deviance;
    bench::Chart chart{
        "Deviance over " + runs.names[i], runs.names[i], "-2 ln likelihood", true, false, {}};
    chart.series = {
        {"simulations", {}, bench::Mark::points},
        {"found, with its 95 % interval",
         {{found.interval.low, best}, {found.value, best}, {found.interval.high, best}},
         bench::Mark::both},
        {"3.84 above it",
         {{found.interval.low, best + kExcluded}, {found.interval.high, best + kExcluded}},
         bench::Mark::line}};
    for (std::size_t k = 0; k < runs.points.size(); ++k)
      if (result.at_points[k].deviance < best + kShown)
        chart.series[0].points.emplace_back(std::exp(runs.points[k].ln_parameters[i]),
                                            result.at_points[k].deviance);
    output::add_chart(page, chart, folder / ("deviance-" + runs.names[i]), missing);
  }
}

}  // namespace

void write_calibration(const std::filesystem::path& folder,
                       const observations::MeasuredVesicles& data, const CalibrationRuns& runs,
                       const calibration::Calibration& result, bool quiet) {
  const CalibrationFindings found = findings_of(data, runs, result);
  const std::vector<output::Row> rows = rows_of(found.parameters, result.unit_at_bound);
  const config::Configuration model = found_model(runs, found.parameters);
  const std::vector<output::Row> agreement = data::agreement_rows(found.agreements);
  const std::vector<std::string> notes = notes_on(data, runs, found, result);
  const bench::Table table = points_table(runs, result);
  posix::write_durably(folder / "calibration.csv", output::csv_text(table));
  input::write_json(folder / "calibration.json", calibration_json(found.parameters, result));
  posix::write_durably(folder / "calibrated.toml", config::config_text(model));
  output::Page page("A model calibrated with measurements");
  page.paragraph(data::title_of(data));
  page.table(rows);
  for (const std::string& note : notes) page.paragraph(note);
  output::Missing missing;
  page.heading("Agreement with the simulations that fit best");
  page.table(agreement);
  page.paragraph(data::about_agreement(found.best.size()));
  add_fit(page, folder, data, found.best, missing);
  page.table(output::table_rows(table));
  add_deviances(page, folder, runs, result, missing);
  output::add_settings(page, model);
  output::add_provenance(page, folder, runs.command);
  posix::write_durably(folder / "calibration.html", page.html());
  if (quiet) return;
  text::say("\n%s\n\n", data::title_of(data));
  output::print_rows(rows);
  for (const std::string& note : notes) text::say("\n%s\n", note);
  text::say("\nagreement with the simulations that fit best:\n");
  output::print_rows(agreement);
  text::say("%s\n", data::about_agreement(found.best.size()));
  if (!result.unit_at_bound)
    text::say("\nrun it with: traceraft run --config %s\n",
              text::in_shell((folder / "calibrated.toml").string()));
  text::say("open next: %s\n", (folder / "calibration.html"));
  if (!missing.text().empty()) text::say("missing from the page: %s\n", missing.text());
}

}  // namespace traceraft::calibrate
