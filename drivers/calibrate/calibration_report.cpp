#include "drivers/calibrate/calibration_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "backends/posix/durable_file.hpp"
#include "drivers/calibrate/calibration_points.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/json_file.hpp"
#include "drivers/output/page.hpp"
#include "drivers/output/provenance.hpp"
#include "drivers/output/text_table.hpp"
#include "drivers/vesicles/agreement_report.hpp"
#include "drivers/vesicles/measured_report.hpp"
#include "kernel/core/text.hpp"
#include "verification/vesicles/calibration_data.hpp"
#include "verification/vesicles/differences.hpp"

namespace traceraft {
namespace {

constexpr double kAtEnd = 1.01;  // of a range

// D in cm²/s from R²/D in seconds.
double diffusion(const Configuration& model, double seconds_per_unit) {
  return model.units().with_seconds_per_unit(seconds_per_unit).diffusion_cm2_s;
}

struct FoundLine {
  std::string name, unit;
  double value, low, high;
  bool determined;
};

// Is D known better than what the size of the vesicles makes of it?
bool size_is_told(double factor, const Interval& unit) {
  constexpr double kSame = 1.2;
  return std::fabs(std::log(factor)) <
         std::max(std::log(kSame), 0.5 * std::log(unit.high / unit.low));
}

// Do the runs that fit best coarsen as the vesicles do?
bool are_alike(const std::vector<Agreement>& agreements, std::size_t runs) {
  return std::none_of(agreements.begin(), agreements.end(), [&](const Agreement& a) {
    return a.quantity != Quantity::fraction && (a.has_trend() || lies_beside(a, runs));
  });
}

// Of D nothing is determined by vesicles of another size, or that coarsen otherwise.
std::vector<FoundLine> findings_of(const MeasuredVesicles& data, const Configuration& model,
                                   bool alike, const Calibration& result) {
  const double factor = factor_of_size(data, model.units().length());
  std::vector<FoundLine> lines;
  for (const CalibratedParameter& p : result.parameters) {
    if (p.name == "seconds_per_unit")
      lines.push_back({"mobility", "cm^2/s", diffusion(model, p.value),
                       diffusion(model, p.interval.high), diffusion(model, p.interval.low),
                       p.determined && size_is_told(factor, p.interval) && alike});
    else
      lines.push_back({p.name, p.name == "fraction" ? "1" : "um", p.value, p.interval.low,
                       p.interval.high, p.determined});
  }
  return lines;
}

// The product of powers of D and the parameters that the data know best.
std::string best_known(const Calibration& result) {
  std::string text;
  for (std::size_t i = 0; i < result.best_powers.size(); ++i) {
    const double power = result.best_powers[i];
    if (std::fabs(power) < 0.1) continue;  // hardly
    text += (text.empty() ? "" : " * ") +
            (i == 0 ? std::string("mobility") : result.parameters[i].name) +
            (std::fabs(power - 1) < 0.02 ? "" : formatted("^%.2f", power));
  }
  return text + formatted(" to %.0f %%", 100 * result.best_deviation);
}

std::vector<Row> rows_of(const std::vector<FoundLine>& lines) {
  std::vector<Row> rows = {
      {"parameter", "value", "95 % interval", "unit", "determined by the data"}};
  for (const FoundLine& line : lines)
    rows.push_back({line.name, formatted("%.3g", line.value),
                    formatted("%.3g to %.3g", line.low, line.high), line.unit,
                    line.determined ? "yes" : "NO"});
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
    const TimeFit& fit = result.at_points[k];
    row.emplace_back(diffusion(runs.model, fit.seconds_per_unit));
    row.emplace_back(fit.scatter);
    row.emplace_back(fit.deviance);
    row.emplace_back(static_cast<double>(points[k].runs.size()));
    table.rows.push_back(row);
  }
  return table;
}

std::string json_text(const std::vector<FoundLine>& lines, const Calibration& result) {
  Json json;
  for (const FoundLine& line : lines)
    json["parameters"][line.name] = {{"value", line.value},
                                     {"interval_95", {line.low, line.high}},
                                     {"unit", line.unit},
                                     {"determined", line.determined}};
  json["best_known"] = best_known(result);
  json["scatter_of_ln_perimeter"] = result.best.scatter;
  json["points_at_bound_of_mobility"] = result.at_bound;
  json["mobility_at_bound"] = result.unit_at_bound;
  json["converged"] = result.converged;
  for (Eigen::Index i = 0; i < result.correlation.rows(); ++i) {
    Json row = Json::array();
    // Of ln D, not of ln R²/D.
    for (Eigen::Index j = 0; j < result.correlation.cols(); ++j)
      row.push_back(result.correlation(i, j) * ((i == 0) != (j == 0) ? -1 : 1));
    json["correlation"].push_back(row);
  }
  return json.dump(2) + "\n";
}

// The model as a configuration, with the parameters that were found.
Configuration found_model(const Configuration& model, const std::vector<std::string>& names,
                          const std::vector<FoundLine>& lines) {
  std::vector<double> values;
  for (std::size_t i = 1; i < lines.size(); ++i) values.push_back(lines[i].value);
  const Configuration at = configuration_at(model, names, values, model.number("t-end"));
  GivenValues given;
  for (const OptionSpec& spec : run_options())
    if (!at.text(spec.name).empty() && spec.name != "output-times" && spec.name != "fields")
      given[spec.name] = {at.text(spec.name), "--" + spec.name};
  given["diffusion"] = {formatted("%.6g", lines[0].value), "--diffusion"};
  return {{}, given};
}

// The runs of a choice, at the D that fits these.
std::vector<History> runs_in_seconds(const CalibrationRuns& all, const Calibration& result,
                                     std::size_t choice) {
  std::vector<History> runs = all.points[choice].runs;
  for (History& run : runs)
    for (double& t : run.time) t *= result.at_points[choice].seconds_per_unit;
  return runs;
}

// Those that fit best.
std::vector<History> best_runs(const CalibrationRuns& all, const Calibration& result) {
  const auto& fits = result.at_points;
  const auto best =
      std::min_element(fits.begin(), fits.end(),
                       [](const TimeFit& a, const TimeFit& b) { return a.deviance < b.deviance; });
  return runs_in_seconds(all, result, static_cast<std::size_t>(best - fits.begin()));
}

// Choices at which there mostly is nothing to compare.
int choices_without_rafts(const MeasuredVesicles& data, const CalibrationRuns& all,
                          const Calibration& result) {
  constexpr double kMost = 0.5;
  int count = 0;
  for (std::size_t k = 0; k < all.points.size(); ++k)
    count += share_without_rafts(data, runs_in_seconds(all, result, k)) > kMost;
  return count;
}

// What is to be known before the numbers.
std::vector<std::string> notes_on(const MeasuredVesicles& data, const CalibrationRuns& runs,
                                  const std::vector<History>& best,
                                  const std::vector<Agreement>& agreements,
                                  const Calibration& result) {
  const std::vector<std::string>& names = runs.names;
  std::vector<std::string> notes;
  if (!runs.missing.empty()) notes.push_back(runs.missing);
  if (!result.converged)
    notes.push_back(
        "NOT CONVERGED: the last simulations do not surround what was found; begin again from the "
        "calibrated model.");
  if (result.unit_at_bound)
    notes.push_back("D LIES AT THE END OF THE SEARCH, and is not known. " + runs.bound);
  else if (result.at_bound > 0)
    notes.push_back(formatted("At %d of %zu choices D fits best where the search for it ends. ",
                              result.at_bound, runs.points.size()) +
                    runs.bound);
  if (const int nothing = looks_that_tell_nothing(data); nothing > 0)
    notes.push_back(
        formatted("%d of %zu measurements are of time zero, of no raft, or of neither perimeter "
                  "nor number: they are not used.",
                  nothing, data.measurements.size()));
  if (const int choices = choices_without_rafts(data, runs, result); choices > 0)
    notes.push_back(formatted(
        "At %d of %zu choices the simulated vesicles have no rafts when the measured ones are "
        "looked at: these choices say nothing of D.",
        choices, runs.points.size()));
  for (const CalibratedParameter& p : result.parameters) {
    if (p.name != "epsilon") continue;
    const double smallest = range_of(runs.model, p.name, runs.most_cells).low;
    if (p.interval.low < kAtEnd * smallest)
      notes.push_back(
          formatted("Epsilon may be smaller than what %d cells resolve, %.3g um, below which it is "
                    "not looked for; take more --most-cells.",
                    runs.most_cells, smallest));
  }
  if (!names.empty() && std::find(names.begin(), names.end(), "noise-length") == names.end())
    notes.push_back(
        "The intervals hold if the initial noise is as long as the model's; if it is not, the "
        "others take the blame. With noise-length among --parameters it is looked for, too.");
  const double radius = runs.model.units().length();
  const double factor = factor_of_size(data, radius);
  if (const CalibratedParameter& unit = result.parameters.front();
      unit.determined && !size_is_told(factor, unit.interval))
    notes.push_back(formatted(
        "THE SIZE OF THE VESICLES decides about D: simulations with --radius %.3g "
        "--cells %.0f would make it %.2g times as large.",
        radius * std::pow(factor, 0.25),
        std::round(static_cast<double>(runs.model.integer("cells")) * std::pow(factor, 0.25)),
        factor));
  for (const std::string& note : cautions(data, radius, best, agreements)) notes.push_back(note);
  return notes;
}

// The measurements in the runs that fit best.
void add_fit(Page& page, const std::filesystem::path& folder, const MeasuredVesicles& data,
             const std::vector<History>& best, Missing& missing) {
  const EnsembleSummary summary = summarise(best);
  for (const Quantity quantity : {Quantity::perimeter, Quantity::rafts}) {
    Chart chart = comparison_chart(data, summary, quantity);
    chart.title += ", of the simulations that fit best";
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

// For readers: what was found beyond the table.
std::vector<std::string> sentences_on(const Calibration& result) {
  std::vector<std::string> sentences;
  if (result.converged && !result.unit_at_bound)
    sentences.push_back("The data know best " + best_known(result) + ".");
  sentences.push_back(result.best.scatter > kAtEnd * kLeastScatter
                          ? formatted("Perimeters scatter by %.0f %% beyond what runs do.",
                                      100 * result.best.scatter)
                          : "Perimeters scatter no more than runs do.");
  return sentences;
}

}  // namespace

void write_calibration(const std::filesystem::path& folder, const MeasuredVesicles& data,
                       const CalibrationRuns& runs, const Calibration& result, bool quiet) {
  const std::vector<History> best = best_runs(runs, result);
  const std::vector<Agreement> agreements = compare_with_runs(data, best);
  const std::vector<FoundLine> lines =
      findings_of(data, runs.model, are_alike(agreements, best.size()), result);
  const std::vector<Row> rows = rows_of(lines);
  const Configuration found = found_model(runs.model, runs.names, lines);
  const std::vector<Row> agreement = agreement_rows(agreements);
  std::vector<std::string> sentences = notes_on(data, runs, best, agreements, result);
  for (const std::string& sentence : sentences_on(result)) sentences.push_back(sentence);
  const Table table = points_table(runs, result);
  write_durably(folder / "calibration.csv", csv_text(table));
  write_durably(folder / "calibration.json", json_text(lines, result));
  write_durably(folder / "calibrated.toml", config_text(found));
  Page page("A model calibrated with measurements");
  page.paragraph(title_of(data));
  page.table(rows);
  for (const std::string& sentence : sentences) page.paragraph(sentence);
  Missing missing;
  page.heading("How well it fits");
  page.table(agreement);
  page.paragraph(about_agreement(best.size()));
  add_fit(page, folder, data, best, missing);
  page.table(table_rows(table));
  add_deviances(page, folder, runs, result, missing);
  add_settings(page, found);
  add_provenance(page, folder, runs.command);
  write_durably(folder / "calibration.html", page.html());
  if (quiet) return;
  std::printf("\n%s\n\n", title_of(data).c_str());
  print_rows(rows);
  for (const std::string& sentence : sentences) std::printf("\n%s\n", sentence.c_str());
  std::printf("\nin the simulations that fit best:\n");
  print_rows(agreement);
  std::printf("%s\n", about_agreement(best.size()).c_str());
  if (!result.unit_at_bound)
    std::printf("\nrun it with: traceraft run --config %s\n", (folder / "calibrated.toml").c_str());
  std::printf("open next: %s\n", (folder / "calibration.html").c_str());
  if (!missing.text().empty()) std::printf("the page lacks: %s\n", missing.text().c_str());
}

}  // namespace traceraft
