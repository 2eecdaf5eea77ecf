#include "drivers/explain/series_report.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/data/agreement_report.hpp"
#include "drivers/data/measured_report.hpp"
#include "drivers/explain/series_strength.hpp"
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

namespace traceraft::explain {
namespace {

namespace fs = std::filesystem;

constexpr int kOfCharts = 10;  // of the curves of charts and power laws

std::string vesicles_text(double count, const selection::SeriesExplanation& found) {
  return std::isfinite(count) ? formatted("%.0f", std::ceil(count))
                              : formatted("more than %d", selection::kMostTimes * found.vesicles);
}

std::string sentence(const selection::SeriesExplanation& found) {
  std::vector<std::string> classes;
  for (const auto& members : found.named) classes.push_back(joined(members, ", "));
  switch (found.finding) {
    case selection::Finding::none:
      return "No significant disagreement: the model explains the series within their scatter.";
    case selection::Finding::not_identifiable:
      return "No significant disagreement, but so few vesicles would not show any effect.";
    case selection::Finding::unnamed:
      return "There is a trend that none of the effects in the search explains" +
             (classes.empty() ? "." : "; " + classes.front() + " comes closest.");
    case selection::Finding::named:
      return "The model lacks " + classes.front() + ".";
    default:
      return "The model lacks one of: " + joined(classes, "; or ") +
             ". Series do not separate these.";
  }
}

std::string share(double p) {
  return formatted(p < 1e-3 ? "%.2f %%" : "%.1f %%", 100 * p);
}

// The basis of the verdict.
std::string ground(const selection::SeriesExplanation& found, const SeriesEnsembles& ensembles,
                   const selection::SeriesRequest& request) {
  return "Basis: " + std::to_string(ensembles.base.size()) +
         " runs of the model, as many of each of " + std::to_string(ensembles.candidates.size()) +
         " effects, and " + std::to_string(request.replicates) +
         " data sets drawn from the model. At most " + share(found.p) +
         " of these sets gain as much by any effect, and at most " + share(found.trend_p) +
         " leave as large a trend. The limits for significance are " + share(request.false_alarms) +
         " for effects and " + share(selection::kTrendLevel * request.false_alarms) +
         " for trends.";
}

// Before and after.
std::vector<output::Row> offset_rows(const selection::SeriesExplanation& found) {
  std::vector<output::Row> rows{
      {"measured relative to", "", "on average", "deviations", "per e-fold of time", "deviations"}};
  const auto add = [&](const std::string& model, const std::vector<selection::SeriesOffset>& all) {
    const auto text = [](double ln) { return formatted("%+.1f %%", 100 * std::expm1(ln)); };
    for (const selection::SeriesOffset& o : all)
      rows.push_back({model, observations::name_of(o.quantity).label, text(o.level),
                      formatted("%+.1f", o.level_deviations), text(o.slope),
                      formatted("%+.1f", o.slope_deviations)});
  };
  add("the model", found.offsets);
  add("the model with " + found.scores.front().effect, found.best_offsets);
  return rows;
}

std::string advice(const selection::SeriesTie& tie, const selection::SeriesExplanation& found) {
  return vesicles_text(tie.vesicles, found) + " vesicles like these would separate " + tie.effect +
         " from " + tie.other + ", mainly by their " + observations::name_of(tie.telling).label +
         ". One vesicle with fields at 8 times says more (traceraft explain --data).";
}

std::vector<output::Row> score_rows(const config::Configuration& model,
                                    const SeriesEnsembles& ensembles,
                                    const selection::SeriesExplanation& found) {
  std::vector<output::Row> rows{{"effect", "2 ln likelihood ratio", "of noise alone", "p",
                                 "p of the trend left", "parameter", "best", "at least", "at most",
                                 "unit", "vesicles needed", "shown by"}};
  for (const selection::SeriesScore& s : found.scores) {
    const ToldStrength told = told_strength(model, ensembles, s);
    rows.push_back({s.effect, formatted("%.1f", s.gain), formatted("%.1f", s.null_mean),
                    formatted("%.3f", s.p), formatted("%.3f", s.trend_p), told.parameter,
                    formatted("%.3g", told.value), told.low ? formatted("%.3g", *told.low) : "",
                    told.high ? formatted("%.3g", *told.high) : "not determined", told.unit,
                    vesicles_text(s.vesicles, found), observations::name_of(s.telling).label});
  }
  return rows;
}

// "exchange with target 0.16, ..."
std::string assumed_text(const config::Configuration& model, const SeriesEnsembles& ensembles,
                         const selection::SeriesExplanation& found) {
  std::string text;
  for (const selection::SeriesScore& score : found.scores) {
    std::string own;
    for (const FoundParameter& p : assumed_parameters(model, ensembles, score))
      own += (own.empty() ? "" : ", ") + p.name + formatted(" %.3g", p.value) +
             (p.unit.empty() ? "" : " " + p.unit);
    if (!own.empty()) text += (text.empty() ? "" : "; ") + score.effect + " with " + own;
  }
  return text;
}

// Each with the D that fits best with it.
SeriesEnsembles in_seconds(SeriesEnsembles ensembles, const selection::SeriesExplanation& found) {
  const auto convert = [](std::vector<observations::History>& runs, double ln_unit) {
    for (observations::History& run : runs)
      for (double& t : run.time) t *= std::exp(ln_unit);
  };
  convert(ensembles.base, found.base.ln_unit);
  for (selection::SeriesCandidate& candidate : ensembles.candidates)
    for (const selection::SeriesScore& score : found.scores)
      if (score.effect == candidate.effect)
        for (selection::SeriesLevel& level : candidate.levels) convert(level.runs, score.ln_unit);
  return ensembles;
}

// The exponents of the perimeter, over the times that were looked at.
std::vector<PerimeterExponent> exponents(const observations::MeasuredVesicles& data,
                                         const SeriesEnsembles& ensembles,
                                         const selection::SeriesExplanation& found) {
  const statistics::Window window = observations::looks(data);
  std::vector<PerimeterExponent> result;
  if (const auto law = observations::fit_measurements(data, window))
    result.push_back({data.synthetic ? "synthetic data" : "measured", *law});
  const auto add = [&](const std::string& name, const std::vector<observations::History>& runs) {
    if (const auto law =
            observations::fit_runs(runs, observations::common_times(runs, kOfCharts), window))
      result.push_back({name, *law});
  };
  add("the model", ensembles.base);
  for (const selection::SeriesCandidate& candidate : ensembles.candidates)
    for (const selection::SeriesScore& score : found.scores)
      if (score.effect == candidate.effect)
        add("with " + candidate.effect, candidate.levels[score.level].runs);
  return result;
}

std::vector<output::Row> exponent_rows(const std::vector<PerimeterExponent>& laws) {
  constexpr double kWide = 1;  // of an exponent
  std::vector<output::Row> rows{
      {"perimeter over radius as c (t - t0)^b", "b", "95 % interval", ""}};
  for (const PerimeterExponent& e : laws) {
    const bool determined = !e.law.t0_open && e.law.b.high - e.law.b.low < kWide;
    rows.push_back({e.model, formatted("%.3f", e.law.law.b),
                    formatted("%.3f to %.3f", e.law.b.low, e.law.b.high),
                    determined ? "" : "not determined: no clear power law at these times"});
  }
  return rows;
}

// The model's curves, and those with the best effect as strong, and with the D, as they fit best.
bench::Chart curve_chart(observations::Quantity quantity,
                         const observations::MeasuredVesicles& data,
                         const SeriesEnsembles& simulated,
                         const selection::SeriesExplanation& found) {
  bench::Chart chart{observations::name_of(quantity).label,        "time (s)",
                     observations::name_of(quantity).label,        true,
                     quantity != observations::Quantity::fraction, {}};
  bench::ChartSeries measured{"measured", {}, bench::Mark::points};
  for (const observations::Measurement& m : data.measurements)
    if (m.of(quantity)) measured.points.emplace_back(m.time, *m.of(quantity));
  chart.series.push_back(measured);
  const selection::SeriesCurves curves(
      selection::SeriesSamples(simulated.base, simulated.candidates), simulated.candidates);
  const auto add = [&](const std::string& name, const std::vector<double>& times, double ln_unit,
                       const likelihood::RunCurves& mean) {
    bench::ChartSeries series{name, {}, bench::Mark::line};
    for (const double t : times)
      series.points.emplace_back(t * std::exp(ln_unit), std::exp(mean.mean(quantity, std::log(t))));
    chart.series.push_back(series);
  };
  const std::vector<double> times = observations::common_times(simulated.base, kOfCharts);
  add("the model", times, found.base.ln_unit, curves.base);
  const selection::SeriesScore& best = found.scores.front();
  for (std::size_t k = 0; k < simulated.candidates.size(); ++k)
    if (simulated.candidates[k].effect == best.effect)
      add("with " + best.effect, times, best.ln_unit, curves.with(k).at(best.amplitude));
  return chart;
}

std::string diffusion_sentence(const config::Configuration& model,
                               const selection::SeriesExplanation& found) {
  const double D = found_units(model, found).diffusion_cm2_s;
  if (found.unit_at_end)
    return formatted(
        "D is not determined: the best one, %.3g cm^2/s, lies at the end of the range searched.",
        D);
  const std::string range =
      formatted("%.3g cm^2/s, within a factor of %.3g (95 %%, from scatter only)", D,
                std::exp(statistics::kNormal95 * found.unit_deviation));
  if (!found.unit_told)
    return "These series say hardly more about D than was known before: " + range + ".";
  if (selection::is_named(found.finding))
    return "With " + found.scores.front().effect +
           formatted(" D is %.3g cm^2/s; without it, it would be %.3g cm^2/s.",
                     units_of(model, found.scores.front().ln_unit).diffusion_cm2_s, D);
  return "D is " + range +
         (found.finding == selection::Finding::unnamed ? ", if what is missing does not change D."
                                                       : ", if nothing is missing.");
}

// D is the inverse of the unit.
std::string range_sentence(const config::Configuration& model,
                           const selection::SeriesExplanation& found) {
  const selection::UnitRange& range = found.unit_range;
  const auto bound = [&](double ln_unit, const std::string& effect, bool open) {
    if (open) return std::string("the end of the search");
    return formatted("%.3g cm^2/s", units_of(model, ln_unit).diffusion_cm2_s) +
           (effect.empty() ? "" : " (" + effect + ")");
  };
  return std::string("With ") +
         (selection::is_named(found.finding) ? "what is named" : "any effect of the search") +
         " at a strength that these data do not exclude, D may be from " +
         bound(range.high, range.high_by, range.high_open) + " to " +
         bound(range.low, range.low_by, range.low_open) + " (95 %).";
}

}  // namespace

void write_series_explanation(const fs::path& folder, const observations::MeasuredVesicles& data,
                              const config::Configuration& model, const SeriesEnsembles& simulated,
                              const selection::SeriesExplanation& found,
                              const selection::SeriesRequest& request, bool quiet) {
  const SeriesEnsembles ensembles = in_seconds(simulated, found);
  const std::vector<PerimeterExponent> laws = exponents(data, ensembles, found);
  const std::string verdict =
      "Verdict of the series: " + verdict_words(found.finding, class_of(found));
  std::vector<std::string> words{data::title_of(data) + ": " + std::to_string(found.vesicles) +
                                     " vesicles, " + std::to_string(found.looks) + " observations.",
                                 sentence(found), ground(found, simulated, request)};
  for (const selection::SeriesTie& tie : found.ties) words.push_back(advice(tie, found));
  words.push_back(diffusion_sentence(model, found));
  words.push_back(range_sentence(model, found));
  if (const std::string onset = data::onset_note(data, ensembles.base); !onset.empty())
    words.push_back(onset);
  words.insert(words.end(), ensembles.notes.begin(), ensembles.notes.end());
  const observations::SimulatedVesicle vesicle =
      observations::simulated_vesicle(model.units().length(), ensembles.base, data);
  for (const std::string& note : observations::differences(data, vesicle)) words.push_back(note);
  if (const std::string text = assumed_text(model, simulated, found); !text.empty())
    words.push_back(
        "For effects with several parameters only the first was varied. Fixed were: " + text + ".");
  for (const auto& members : found.classes)
    if (members.size() > 1)
      words.push_back("These effects look alike in series: " + joined(members, ", ") + ".");
  const std::vector<output::Row> offset = offset_rows(found),
                                 scores = score_rows(model, simulated, found),
                                 exponent = exponent_rows(laws);

  output::Page page("What series of vesicles say about the model");
  page.heading(verdict);
  for (const std::string& line : words) page.paragraph(line);
  page.table(offset);
  page.table(scores);
  page.heading("Exponents");
  page.table(exponent);
  page.heading("In time");
  output::Missing missing;
  for (const observations::Quantity quantity : observations::kQuantities) {
    const bench::Chart chart = curve_chart(quantity, data, simulated, found);
    output::add_chart(page, chart,
                      folder / (std::string("series-") + observations::name_of(quantity).id),
                      missing);
  }
  page.paragraph(output::program_text() + "; simulations in " + simulated.folder.string() + ".");
  posix::write_durably(folder / "series.html", page.html());
  input::write_json(folder / "series.json", series_json(model, simulated, found, laws));
  if (quiet) return;
  text::say("\n%s\n", verdict);
  for (const std::string& line : words) text::say("%s\n", line);
  text::say("\n");
  output::print_rows(offset);
  text::say("\n");
  output::print_rows(scores);
  text::say("\n");
  output::print_rows(exponent);
  text::say("\nwritten: %s\n", (folder / "series.html"));
  if (!missing.text().empty()) text::say("missing from the page: %s\n", missing.text());
}

}  // namespace traceraft::explain
