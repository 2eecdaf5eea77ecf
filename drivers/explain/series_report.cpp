#include "drivers/explain/series_report.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "drivers/data/agreement_report.hpp"
#include "drivers/data/measured_report.hpp"
#include "drivers/explain/series_verdict.hpp"
#include "drivers/explain/verdict_sentence.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/page.hpp"
#include "drivers/output/program.hpp"
#include "drivers/output/text_table.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/text.hpp"
#include "verification/observations/differences.hpp"
#include "verification/selection/series/series_need.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

constexpr int kOfCharts = 10;  // of the curves of charts and power laws

std::string vesicles_text(double count, const SeriesExplanation& found) {
  return std::isfinite(count) ? formatted("%.0f", std::ceil(count))
                              : formatted("more than %d", kMostTimes * found.vesicles);
}

std::string sentence(const SeriesExplanation& found) {
  std::vector<std::string> classes;
  for (const auto& members : found.named) classes.push_back(joined(members, ", "));
  switch (found.finding) {
    case Finding::none:
      return "No significant disagreement: the model explains the series within their scatter.";
    case Finding::not_identifiable:
      return "No significant disagreement, but so few vesicles would not show any effect.";
    case Finding::unnamed:
      return "There is a trend that none of the effects in the search explains" +
             (classes.empty() ? "." : "; " + classes.front() + " comes closest.");
    case Finding::named:
      return "The model lacks " + classes.front() + ".";
    default:
      return "The model lacks one of: " + joined(classes, "; or ") +
             ". Series do not separate these.";
  }
}

std::string share(double p) {
  return formatted(p < 1e-3 ? "%.2f %%" : "%.1f %%", 100 * p);
}

// What the verdict rests on.
std::string ground(const SeriesExplanation& found, const SeriesEnsembles& ensembles,
                   const SeriesRequest& request) {
  return "Basis: " + std::to_string(ensembles.base.size()) +
         " runs of the model, as many of each of " + std::to_string(ensembles.candidates.size()) +
         " effects, and " + std::to_string(request.replicates) +
         " data sets drawn from the model. At most " + share(found.p) +
         " of these sets gain as much by any effect, and at most " + share(found.trend_p) +
         " leave as large a trend. The limits for significance are " + share(request.false_alarms) +
         " for effects and " + share(kTrendLevel * request.false_alarms) + " for trends.";
}

std::vector<Row> offset_rows(const SeriesExplanation& found) {
  std::vector<Row> rows{{"measured relative to the model", "on average", "deviations",
                         "per e-fold of time", "deviations"}};
  for (const SeriesOffset& o : found.offsets) {
    const auto text = [](double ln) { return formatted("%+.1f %%", 100 * std::expm1(ln)); };
    rows.push_back({name_of(o.quantity).label, text(o.level),
                    formatted("%+.1f", o.level_deviations), text(o.slope),
                    formatted("%+.1f", o.slope_deviations)});
  }
  return rows;
}

std::string advice(const SeriesTie& tie, const SeriesExplanation& found) {
  return vesicles_text(tie.vesicles, found) + " vesicles like these would separate " + tie.effect +
         " from " + tie.other + ", mainly by their " + name_of(tie.telling).label +
         ". One vesicle with fields at 8 times says more (traceraft explain --data).";
}

std::vector<Row> score_rows(const Configuration& model, const SeriesExplanation& found) {
  std::vector<Row> rows{{"effect", "2 ln likelihood ratio", "of noise alone", "p", "parameter",
                         "at least", "at most", "unit", "vesicles needed", "shown by"}};
  for (const SeriesScore& s : found.scores) {
    const StrengthScale scale = scale_of(s, model);
    rows.push_back({s.effect, formatted("%.1f", s.gain), formatted("%.1f", s.null_mean),
                    formatted("%.3f", s.p), scale.parameter,
                    s.bounded ? formatted("%.3g", scale.factor * s.low) : "",
                    s.bounded ? formatted("%.3g", scale.factor * s.high) : "not determined",
                    scale.unit, vesicles_text(s.vesicles, found), name_of(s.telling).label});
  }
  return rows;
}

// "exchange with target 0.16, ..."
std::string assumed_text(const SeriesEnsembles& ensembles, const Units& units) {
  std::string text;
  for (const EffectTerm& term : ensembles.terms) {
    std::string own;
    for (const FoundParameter& p : assumed_parameters(term, units))
      own += (own.empty() ? "" : ", ") + p.name + formatted(" %.3g", p.value) +
             (p.unit.empty() ? "" : " " + p.unit);
    if (!own.empty()) text += (text.empty() ? "" : "; ") + term.effect + " with " + own;
  }
  return text;
}

// Each with the D that fits best with it.
SeriesEnsembles in_seconds(SeriesEnsembles ensembles, const SeriesExplanation& found) {
  const auto convert = [](std::vector<History>& runs, double ln_unit) {
    for (History& run : runs)
      for (double& t : run.time) t *= std::exp(ln_unit);
  };
  convert(ensembles.base, found.base.ln_unit);
  for (SeriesCandidate& candidate : ensembles.candidates)
    for (const SeriesScore& score : found.scores)
      if (score.effect == candidate.effect) convert(candidate.runs, score.ln_unit);
  return ensembles;
}

// Of the perimeter, over the times that were looked at.
std::vector<PerimeterExponent> exponents(const MeasuredVesicles& data,
                                         const SeriesEnsembles& ensembles) {
  const Window window = looks(data);
  std::vector<PerimeterExponent> result;
  if (const auto law = fit_measurements(data, window))
    result.push_back({data.synthetic ? "synthetic data" : "measured", *law});
  const auto add = [&](const std::string& name, const std::vector<History>& runs) {
    if (const auto law = fit_runs(runs, common_times(runs, kOfCharts), window))
      result.push_back({name, *law});
  };
  add("the model", ensembles.base);
  for (const SeriesCandidate& candidate : ensembles.candidates)
    add("with " + candidate.effect, candidate.runs);
  return result;
}

std::vector<Row> exponent_rows(const std::vector<PerimeterExponent>& laws) {
  constexpr double kWide = 1;  // of an exponent
  std::vector<Row> rows{{"perimeter over radius as c (t - t0)^b", "b", "95 % interval", ""}};
  for (const PerimeterExponent& e : laws) {
    const bool determined = !e.law.t0_open && e.law.b.high - e.law.b.low < kWide;
    rows.push_back({e.model, formatted("%.3f", e.law.law.b),
                    formatted("%.3f to %.3f", e.law.b.low, e.law.b.high),
                    determined ? "" : "not determined: no clear power law at these times"});
  }
  return rows;
}

// The model's curves, and those with the best effect as strong, and with the D, as they fit best.
Chart curve_chart(Quantity quantity, const MeasuredVesicles& data, const SeriesEnsembles& simulated,
                  const SeriesExplanation& found) {
  Chart chart{name_of(quantity).label,        "time (s)", name_of(quantity).label, true,
              quantity != Quantity::fraction, {}};
  ChartSeries measured{"measured", {}, Mark::points};
  for (const Measurement& m : data.measurements)
    if (m.of(quantity)) measured.points.emplace_back(m.time, *m.of(quantity));
  chart.series.push_back(measured);
  const RunCurves base(simulated.base);
  const auto add = [&](const std::string& name, const std::vector<double>& times, double ln_unit,
                       const std::function<double(double)>& ln_mean) {
    ChartSeries series{name, {}, Mark::line};
    for (const double t : times)
      series.points.emplace_back(t * std::exp(ln_unit), std::exp(ln_mean(std::log(t))));
    chart.series.push_back(series);
  };
  const auto of_base = [&](double ln_t) { return base.mean(quantity, ln_t); };
  add("the model", common_times(simulated.base, kOfCharts), found.base.ln_unit, of_base);
  const SeriesScore& best = found.scores.front();
  for (const SeriesCandidate& candidate : simulated.candidates) {
    if (candidate.effect != best.effect) continue;
    const RunCurves changed(candidate.runs);
    const double amplitude = best.value / candidate.strength;
    add("with " + candidate.effect, common_times(candidate.runs, kOfCharts), best.ln_unit,
        [&](double ln_t) {
          return of_base(ln_t) + amplitude * (changed.mean(quantity, ln_t) - of_base(ln_t));
        });
  }
  return chart;
}

std::string diffusion_sentence(const Configuration& model, const SeriesExplanation& found) {
  const double D = found_units(model, found).diffusion_cm2_s;
  if (found.unit_at_end)
    return formatted(
        "D is not determined: the best one, %.3g cm^2/s, lies at the end of the range searched.",
        D);
  const std::string range =
      formatted("%.3g cm^2/s, within a factor of %.3g (95 %%, from scatter only)", D,
                std::exp(kNormal95 * found.unit_deviation));
  if (!found.unit_told)
    return "These series say hardly more about D than was known before: " + range + ".";
  return "D is " + range +
         (found.finding == Finding::unnamed ? ", if what is missing does not change D."
                                            : ", if nothing is missing.");
}

}  // namespace

void write_series_explanation(const fs::path& folder, const MeasuredVesicles& data,
                              const Configuration& model, const SeriesEnsembles& simulated,
                              const SeriesExplanation& found, const SeriesRequest& request,
                              bool quiet) {
  const SeriesEnsembles ensembles = in_seconds(simulated, found);
  const std::vector<PerimeterExponent> laws = exponents(data, ensembles);
  const std::string verdict =
      "Verdict of the series: " + verdict_words(found.finding, class_of(found));
  std::vector<std::string> words{title_of(data) + ": " + std::to_string(found.vesicles) +
                                     " vesicles, " + std::to_string(found.looks) + " observations.",
                                 sentence(found), ground(found, simulated, request)};
  for (const SeriesTie& tie : found.ties) words.push_back(advice(tie, found));
  words.push_back(diffusion_sentence(model, found));
  if (const std::string onset = onset_note(data, ensembles.base); !onset.empty())
    words.push_back(onset);
  words.insert(words.end(), ensembles.notes.begin(), ensembles.notes.end());
  const SimulatedVesicle vesicle = simulated_vesicle(model.units().length(), ensembles.base, data);
  for (const std::string& note : differences(data, vesicle)) words.push_back(note);
  if (const std::string text = assumed_text(simulated, found_units(model, found)); !text.empty())
    words.push_back(
        "For effects with several parameters only the first was varied. Fixed were: " + text + ".");
  for (const auto& members : found.classes)
    if (members.size() > 1)
      words.push_back("These effects look alike in series: " + joined(members, ", ") + ".");
  const std::vector<Row> offset = offset_rows(found), scores = score_rows(model, found),
                         exponent = exponent_rows(laws);

  Page page("What series of vesicles say about the model");
  page.heading(verdict);
  for (const std::string& line : words) page.paragraph(line);
  page.table(offset);
  page.table(scores);
  page.heading("Exponents");
  page.table(exponent);
  page.heading("In time");
  Missing missing;
  for (const Quantity quantity : kQuantities) {
    const Chart chart = curve_chart(quantity, data, simulated, found);
    add_chart(page, chart, folder / (std::string("series-") + name_of(quantity).id), missing);
  }
  page.paragraph(program_text() + "; simulations in " + simulated.folder.string() + ".");
  write_durably(folder / "series.html", page.html());
  write_durably(folder / "series.json", series_json(model, simulated, found, laws).dump(2) + "\n");
  if (quiet) return;
  say("\n%s\n", verdict);
  for (const std::string& line : words) say("%s\n", line);
  say("\n");
  print_rows(offset);
  say("\n");
  print_rows(scores);
  say("\n");
  print_rows(exponent);
  say("\nwritten: %s\n", (folder / "series.html"));
  if (!missing.text().empty()) say("missing from the page: %s\n", missing.text());
}

}  // namespace traceraft
