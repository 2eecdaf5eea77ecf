#include "drivers/vesicles/measured_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "backends/posix/durable_file.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/ensemble/ensemble_report.hpp"
#include "drivers/ensemble/histories_file.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/json_file.hpp"
#include "drivers/output/page.hpp"
#include "drivers/output/provenance.hpp"
#include "drivers/output/text_table.hpp"
#include "drivers/vesicles/agreement_report.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"
#include "verification/vesicles/raft_fraction.hpp"
#include "verification/vesicles/resolvable.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

std::string spread(const std::vector<double>& values) {
  if (values.empty()) return "not measured";
  const Distribution d = distribution(values);
  return formatted("%.4g +- %.2g, from %.4g to %.4g (%zu measurements)", d.mean, d.deviation, d.min,
                   d.max, values.size());
}

std::vector<double> values_of(const MeasuredVesicles& data, Quantity quantity) {
  std::vector<double> values;
  for (const Measurement& m : data.measurements)
    if (m.of(quantity)) values.push_back(*m.of(quantity));
  return values;
}

std::string origin_of(const MeasuredVesicles& data) {
  return data.synthetic ? "synthetic measurements" : "measured";
}

std::string about(const MeasuredVesicles& data) {
  return title_of(data) + ": " + std::to_string(data.vesicles().size()) + " vesicles, " +
         std::to_string(data.measurements.size()) + " measurements" +
         (data.origin.empty() ? "" : "; " + data.origin);
}

// From composition and temperature alone.
std::string estimated_fraction(const std::string& composition, double celsius) {
  try {
    const RaftFractionEstimate estimate =
        estimated_raft_fraction(membrane_mixture("composition", composition), celsius);
    return formatted("%.4g, ", estimate.area) + estimate.how;
  } catch (const InputError& error) {
    return std::string("unknown (") + error.what() + ")";
  }
}

Row law_row(const std::string& of, const std::optional<FittedLaw>& law) {
  if (!law) return {of, "too few points", "", "", "", ""};
  const auto with = [](double value, const Interval& interval) {
    return formatted("%.3g (%.3g to %.3g)", value, interval.low, interval.high);
  };
  return {of,
          with(law->law.b, law->b),
          law->t0_open ? formatted("%.3g (to %.3g)", law->law.t0, law->t0.high)
                       : with(law->law.t0, law->t0),
          with(law->law.c, law->c),
          formatted("%.2f", law->law.scatter),
          std::to_string(law->points)};
}

const Row kLawHeading = {
    "perimeter / radius = c (t - t0)^b", "b (95 %)", "t0 (s)", "c", "scatter of ln", "points"};

// For readers of laws whose start may lie before all that was tried; nothing if there is none.
std::vector<std::string> remarks_on(std::initializer_list<std::optional<FittedLaw>> laws) {
  for (const std::optional<FittedLaw>& law : laws)
    if (law && law->t0_open)
      return {
          "Where t0 has no lower end, it may be earlier than ten times the time before time zero "
          "of the first point, where it is no longer looked for; b may then be lower and c larger "
          "than their intervals."};
  return {};
}

Row law_row(const PublishedFacts& facts) {
  const PowerLaw& law = facts.perimeter;
  return {formatted("published, %g to %g s", facts.window.begin, facts.window.end),
          formatted("%.3g", law.b),
          formatted("%.3g", law.t0),
          formatted("%.3g", law.c),
          formatted("%.2f (assumed)", law.scatter),
          std::to_string(facts.measurements)};
}

std::string about(const PublishedFacts& facts) {
  std::string text =
      "Published (" + facts.origin +
      formatted("): raft fraction %.3g +- %.2g, %d measurements of %d vesicles.", facts.fraction,
                facts.fraction_sd, facts.measurements, facts.vesicles);
  if (facts.outliers >= 0)
    text += formatted(
        " Of their numbers of rafts, %d lie outside the range of the published "
        "simulations.",
        facts.outliers);
  return text;
}

void refuse_other_membrane(const MeasuredVesicles& data, const PublishedFacts& facts) {
  if (data.composition.empty() || same_membrane(data.composition, facts.composition)) return;
  throw InputError("--facts: they are of " + facts.composition + ", the measurements of " +
                   data.composition);
}

ChartSeries law_curve(const std::string& name, const PowerLaw& law, const Window& window) {
  ChartSeries series{name, {}, Mark::line};
  constexpr int kPoints = 40;
  for (int i = 0; i <= kPoints; ++i) {
    const double t = std::max(window.begin, 1e-3) *
                     std::pow(window.end / std::max(window.begin, 1e-3), i * 1.0 / kPoints);
    if (t > law.t0) series.points.emplace_back(t, law.at(t));
  }
  return series;
}

}  // namespace

Chart comparison_chart(const MeasuredVesicles& data, const EnsembleSummary& summary,
                       Quantity quantity) {
  Chart chart = ensemble_chart(summary, quantity, true);
  double first = HUGE_VAL;
  for (const Measurement& m : data.measurements) first = std::min(first, m.time);
  for (ChartSeries& series : chart.series) {
    std::size_t early = 0;
    while (early < series.points.size() && series.points[early].first < 0.1 * first) ++early;
    series.points.erase(series.points.begin(), series.points.begin() + early);
    if (!series.other.empty())
      series.other.erase(series.other.begin(), series.other.begin() + early);
  }
  ChartSeries measured{origin_of(data), {}, Mark::bars};
  for (const Measurement& m : data.measurements) {
    if (!m.of(quantity)) continue;
    measured.points.emplace_back(m.time, *m.of(quantity));
    measured.other.push_back(m.sigma_of(quantity));
  }
  chart.series.push_back(measured);
  return chart;
}

std::string title_of(const MeasuredVesicles& data) {
  return data.name + (data.synthetic ? " (SYNTHETIC, not measured)" : "");
}

void print_dataset(const MeasuredVesicles& data, const std::optional<FittedLaw>& law,
                   const Window& window) {
  std::printf("%s\n", about(data).c_str());
  double first = HUGE_VAL, last = 0;
  std::vector<double> radii;
  for (const Measurement& m : data.measurements) {
    first = std::min(first, m.time);
    last = std::max(last, m.time);
    radii.push_back(m.radius);
  }
  std::printf("  %-22s %.4g to %.4g s after time zero (%s)\n", "time", first, last,
              data.time_zero.c_str());
  std::printf("  %-22s %s\n", "radius (um)", spread(radii).c_str());
  for (const Quantity quantity : kQuantities)
    std::printf("  %-22s %s\n", name_of(quantity).label, spread(values_of(data, quantity)).c_str());
  if (!data.composition.empty() && data.celsius)
    std::printf("  %-22s %s\n", "estimated fraction",
                estimated_fraction(data.composition, *data.celsius).c_str());
  if (const std::string doubt = too_long_boundaries(data); !doubt.empty())
    std::printf("\nNOTE: %s\n", doubt.c_str());
  std::printf("\npower law from %g to %g s\n", window.begin, window.end);
  print_rows({kLawHeading, law_row(origin_of(data), law)});
  for (const std::string& remark : remarks_on({law})) std::printf("%s\n", remark.c_str());
}

Configuration model_of(const fs::path& path) {
  const EnsembleFolder folder(path);
  if (!folder.started() && !(fs::exists(folder.config()) && fs::exists(path / kHistoriesFile)))
    throw InputError("--ensemble: " + path.string() + " holds no ensemble (traceraft ensemble)");
  const Configuration configuration(read_config_file(folder.config()), {});
  if (configuration.units().scaled)
    throw InputError("--ensemble: " + path.string() +
                     " was run with --scaled; its times cannot be compared with seconds");
  return configuration;
}

std::vector<History> runs_of(const fs::path& path) {
  const Configuration model = model_of(path);
  const EnsembleFolder folder(path);
  const fs::path kept = path / kHistoriesFile;
  if (folder.started()) {
    const std::vector<History> runs =
        finished_members(folder, model.units().length(), model.number("t-end")).histories;
    if (!runs.empty() || !fs::exists(kept)) return runs;
  }
  return read_histories(kept);
}

int compare_with_ensemble(const MeasuredVesicles& data, const ComparisonRequest& request) {
  const Window& window = request.window;
  if (request.facts) refuse_other_membrane(data, *request.facts);
  const std::vector<History> runs = runs_of(request.ensemble);
  const std::vector<Agreement> agreements = compare_with_runs(data, runs);
  const EnsembleSummary summary = summarise(runs);
  const auto measured = fit_measurements(data, window),
             simulated = fit_runs(runs, summary.times, window);
  const std::vector<Row> rows = agreement_rows(agreements);
  std::vector<Row> laws = {kLawHeading, law_row(origin_of(data), measured),
                           law_row("simulated", simulated)};
  if (request.facts) laws.push_back(law_row(*request.facts));
  Page page("Measured and simulated vesicles");
  page.paragraph(about(data) + ".");
  if (request.facts) page.paragraph(about(*request.facts));
  page.paragraph(std::to_string(runs.size()) + " runs in " + request.ensemble.string() + ". " +
                 about_agreement(runs.size()));
  page.table(rows);
  const Configuration model = model_of(request.ensemble);
  const double radius = model.units().length();
  std::vector<std::string> notes = differences(data, simulated_vesicle(radius, runs, data));
  if (model.text("surface") != "sphere")
    notes.push_back("The simulated surface is no sphere: " + model.text("surface") + ".");
  if (const std::string doubt = too_long_boundaries(data); !doubt.empty()) notes.push_back(doubt);
  for (const std::string& note : doubts_of(agreements)) notes.push_back(note);
  for (const std::string& note : notes) page.paragraph(note);
  page.paragraph(formatted("Power laws fitted from %g to %g s.", window.begin, window.end));
  page.table(laws);
  std::vector<std::string> remarks = remarks_on({measured, simulated});
  if (summary.times.back() < 0.99 * window.end)
    remarks.push_back(
        formatted("The runs end at %.4g s: their law is fitted until then.", summary.times.back()));
  for (const std::string& remark : remarks) page.paragraph(remark);
  fs::create_directories(request.out);
  Missing missing;
  for (const Quantity quantity : kQuantities) {
    Chart chart = comparison_chart(data, summary, quantity);
    if (quantity == Quantity::perimeter && measured)
      chart.series.push_back(law_curve("law of the measurements", measured->law, window));
    if (quantity == Quantity::perimeter && simulated)
      chart.series.push_back(law_curve("law of the simulations", simulated->law, window));
    if (quantity == Quantity::perimeter && request.facts)
      chart.series.push_back(
          law_curve("published law", request.facts->perimeter, request.facts->window));
    add_chart(page, chart, request.out / (std::string("comparison-") + name_of(quantity).id),
              missing);
  }
  add_settings(page, model);
  add_provenance(page, request.ensemble, request.command);
  write_durably(request.out / "comparison.json",
                Json{{"runs", runs.size()}, {"data", data.name}}.dump(2) + "\n");
  write_durably(request.out / "comparison.csv", csv_text(agreement_table(agreements)));
  write_durably(request.out / "comparison.html", page.html());
  if (!request.quiet) {
    std::printf("%s\n\n", about(data).c_str());
    print_rows(rows);
    std::printf("%s\n\npower laws from %g to %g s\n", about_agreement(runs.size()).c_str(),
                window.begin, window.end);
    print_rows(laws);
    for (const std::string& remark : remarks) std::printf("%s\n", remark.c_str());
    for (const std::string& note : notes) std::printf("\n%s\n", note.c_str());
    std::printf("\nopen next: %s\n", (request.out / "comparison.html").c_str());
    if (!missing.text().empty()) std::printf("the page lacks: %s\n", missing.text().c_str());
  }
  return kSuccess;
}

}  // namespace traceraft
