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

namespace traceraft {
namespace {

// Between the end of a search and itself there is no interval.
std::vector<Row> rows_of(const std::vector<CalibrationFinding>& parameters, bool mobility_at_end) {
  std::vector<Row> rows = {
      {"parameter", "value", "95 % interval", "unit", "determined by the data"}};
  for (const CalibrationFinding& found : parameters)
    rows.push_back({found.name, formatted("%.3g", found.value),
                    mobility_at_end && found.name == "mobility"
                        ? "at the end of the range searched"
                        : formatted("%.3g to %.3g", found.low, found.high),
                    found.unit, found.determined() ? "yes" : "NO: " + joined(found.open, "; ")});
  return rows;
}

Table points_table(const CalibrationRuns& runs, const Calibration& result) {
  const std::vector<CalibrationPoint>& points = runs.points;
  Table table{"calibration", runs.names, {}};
  for (const char* column : {"mobility", "scatter", "deviance", "runs"})
    table.columns.push_back(column);
  for (std::size_t k = 0; k < points.size(); ++k) {
    std::vector<Cell> row;
    for (const double ln : points[k].ln_parameters) row.emplace_back(std::exp(ln));
    const EnsembleFit& fit = result.at_points[k];
    row.emplace_back(diffusion(runs.model, fit.seconds_per_unit()));
    row.emplace_back(fit.scatter_beyond_runs(Quantity::perimeter));
    row.emplace_back(fit.deviance);
    row.emplace_back(static_cast<double>(points[k].runs.size()));
    table.rows.push_back(row);
  }
  return table;
}

// The measurements in the runs that fit best.
void add_fit(Page& page, const std::filesystem::path& folder, const MeasuredVesicles& data,
             const std::vector<History>& best, Missing& missing) {
  const EnsembleSummary summary = summarise(best);
  for (const Quantity quantity : {Quantity::perimeter, Quantity::rafts}) {
    Chart chart = comparison_chart(data, summary, quantity);
    chart.title += " and the simulations that fit best";
    add_chart(page, chart, folder / (std::string("fit-") + name_of(quantity).id), missing);
  }
}

// Within what counts of the best: what is further away only flattens the rest.
void add_deviances(Page& page, const std::filesystem::path& folder, const CalibrationRuns& runs,
                   const Calibration& result, Missing& missing) {
  constexpr double kShown = 50, kExcluded = 3.84;
  for (std::size_t i = 0; i < runs.names.size(); ++i) {
    const CalibratedParameter& found = result.parameters[i + 1];
    const double best = result.best.deviance;
    Chart chart{
        "Deviance over " + runs.names[i], runs.names[i], "-2 ln likelihood", true, false, {}};
    chart.series = {
        {"simulations", {}, Mark::points},
        {"found, with its 95 % interval",
         {{found.interval.low, best}, {found.value, best}, {found.interval.high, best}},
         Mark::both},
        {"3.84 above it",
         {{found.interval.low, best + kExcluded}, {found.interval.high, best + kExcluded}},
         Mark::line}};
    for (std::size_t k = 0; k < runs.points.size(); ++k)
      if (result.at_points[k].deviance < best + kShown)
        chart.series[0].points.emplace_back(std::exp(runs.points[k].ln_parameters[i]),
                                            result.at_points[k].deviance);
    add_chart(page, chart, folder / ("deviance-" + runs.names[i]), missing);
  }
}

}  // namespace

void write_calibration(const std::filesystem::path& folder, const MeasuredVesicles& data,
                       const CalibrationRuns& runs, const Calibration& result, bool quiet) {
  const CalibrationFindings found = findings_of(data, runs, result);
  const std::vector<Row> rows = rows_of(found.parameters, result.unit_at_bound);
  const Configuration model = found_model(runs, found.parameters);
  const std::vector<Row> agreement = agreement_rows(found.agreements);
  const std::vector<std::string> notes = notes_on(data, runs, found, result);
  const Table table = points_table(runs, result);
  write_durably(folder / "calibration.csv", csv_text(table));
  write_durably(folder / "calibration.json", calibration_json(found.parameters, result));
  write_durably(folder / "calibrated.toml", config_text(model));
  Page page("A model calibrated with measurements");
  page.paragraph(title_of(data));
  page.table(rows);
  for (const std::string& note : notes) page.paragraph(note);
  Missing missing;
  page.heading("Agreement with the simulations that fit best");
  page.table(agreement);
  page.paragraph(about_agreement(found.best.size()));
  add_fit(page, folder, data, found.best, missing);
  page.table(table_rows(table));
  add_deviances(page, folder, runs, result, missing);
  add_settings(page, model);
  add_provenance(page, folder, runs.command);
  write_durably(folder / "calibration.html", page.html());
  if (quiet) return;
  say("\n%s\n\n", title_of(data));
  print_rows(rows);
  for (const std::string& note : notes) say("\n%s\n", note);
  say("\nagreement with the simulations that fit best:\n");
  print_rows(agreement);
  say("%s\n", about_agreement(found.best.size()));
  if (!result.unit_at_bound)
    say("\nrun it with: traceraft run --config %s\n",
        in_shell((folder / "calibrated.toml").string()));
  say("open next: %s\n", (folder / "calibration.html"));
  if (!missing.text().empty()) say("missing from the page: %s\n", missing.text());
}

}  // namespace traceraft
