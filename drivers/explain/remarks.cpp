#include "drivers/explain/remarks.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "drivers/explain/found_parameters.hpp"
#include "drivers/explain/verdict_sentence.hpp"
#include "kernel/core/text.hpp"
#include "verification/selection/series/brownian_viscosity.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::explain {
namespace {

// "Vesicle 1, snapshot 3 (12 s): it seems to be rotated by 0.30 rad ..."
std::string text_of(const selection::FrameChange& change, const ExplainSetup& setup) {
  std::vector<std::string> ways;
  if (change.rotation != 0)
    ways.push_back(formatted("rotated by %.2g rad since the previous snapshot", change.rotation));
  if (change.gain != 0) ways.push_back(formatted("scaled by %.3g", 1 + change.gain));
  if (change.offset != 0) ways.push_back(formatted("shifted by %.2g", change.offset));
  const assimilation::FieldSeries& series = setup.series[change.vesicle];
  const double time = series.snapshots[change.snapshot].time;
  return "Vesicle " + series.vesicle + ", snapshot " + std::to_string(change.snapshot + 1) +
         formatted(" (%.4g s)", time * setup.configuration.units().seconds_per_unit()) +
         ": it seems to be " + joined(ways, ", and ") +
         ". This is more than the search corrects. Align and calibrate the images first.";
}

// Rotations that were found and corrected.
void add_registered(const selection::Explanation& found, const ExplainSetup& setup,
                    std::vector<std::string>& all) {
  if (found.registered.empty()) return;
  std::vector<std::string> turns;
  for (const selection::RegisteredRotation& turn : found.registered)
    turns.push_back(
        formatted("%.2g rad before snapshot %zu", turn.angle, turn.snapshot + 1) +
        (setup.series.size() > 1 ? " of vesicle " + setup.series[turn.vesicle].vesicle : ""));
  all.push_back(
      "The vesicle rotated between snapshots. The search found and corrected these rotations: " +
      joined(turns, ", ") + ".");
}

void add_failures(const selection::Explanation& found, std::vector<std::string>& all) {
  for (const selection::Round& round : found.rounds)
    for (const selection::Round::Failure& failure : round.failures)
      all.push_back("The refit of a model with " + failure.effect + " failed: " + failure.why);
  if (!found.stopped.empty())
    all.push_back("The search stopped at the model with " + found.found.hypothesis.name() + ": " +
                  found.stopped);
}

// Remarks on the parameters of found effects that were not looked for.
void add_assumptions(const selection::Explanation& found, const physics::Units& base,
                     std::vector<std::string>& all) {
  std::map<std::string, std::vector<std::string>> assumed;  // of each effect
  const assimilation::Hypothesis& own = found.rounds.front().known.hypothesis;
  for (const FoundParameter& p : found_parameters(found.found, base))
    if (!p.sigma && !own.has(p.effect))
      assumed[p.effect].push_back(p.name + formatted(" = %.4g", p.value) +
                                  (p.unit.empty() ? "" : " " + p.unit));
  for (const auto& [effect, values] : assumed)
    all.push_back(effect + " was searched for with " + joined(values, ", ") +
                  " only. With other values its strength would differ, and the search might take "
                  "it for another effect.");
}

// Strengths that the model states and these data contradict.
void add_own(const selection::Explanation& found, const ExplainSetup& setup,
             std::vector<std::string>& all) {
  const physics::Units base = setup.configuration.units();
  const std::vector<FoundParameter> fitted = found_parameters(fit_shown(found), base);
  const auto contradicts = [](const FoundParameter& p, const FoundParameter& stated) {
    return p.name == stated.name && p.sigma && std::fabs(p.value - stated.value) > kSure * *p.sigma;
  };
  for (const assimilation::Hypothesis::Part& part : setup.request.own.parts)
    for (const FoundParameter& stated : parameters_of(part.candidate.term(part.coefficients), base))
      for (const FoundParameter& p : fitted)
        if (p.effect == part.candidate.name && contradicts(p, stated))
          all.push_back(
              "The model states " + p.effect + " with " + p.name +
              formatted(" = %.4g. These data contradict it: the fit is %.4g (standard error %.2g).",
                        stated.value, p.value, *p.sigma));
  const assimilation::Hypothesis& shown = fit_shown(found).hypothesis;
  for (std::size_t k = 0; k < shown.known; ++k) {
    const assimilation::Candidate& candidate = shown.parts[k].candidate;
    if (candidate.term(shown.parts[k].coefficients).values[candidate.parameter] == 0)
      all.push_back("These data show nothing of the model's " + candidate.name + ".");
  }
}

// The user learns which times would help.
void add_rest(const ExplainSetup& setup, std::vector<std::string>& all) {
  const double unit = setup.configuration.units().seconds_per_unit();
  double first = HUGE_VAL;
  for (const assimilation::FieldSeries& vesicle : setup.series)
    first = std::min(first, vesicle.snapshots.front().time * unit);
  all.push_back(formatted(
      "All snapshots are of rafts at rest, the first at %.4g s. Earlier snapshots would help.",
      first));
}

// A mistake in the unit of time looks like another D.
void add_diffusion_ratio(const selection::Explanation& found, const physics::Units& base,
                         std::vector<std::string>& all) {
  const double log_diffusion_ratio = std::fabs(std::log(found.found.diffusion_ratio));
  const double D = base.diffusion_cm2_s * found.found.diffusion_ratio;
  // The D found is between the two, and its difference from the known D varies as much less.
  const double square =
      found.diffusion_ratio_doubt * found.diffusion_ratio_doubt -
      found.found.diffusion_ratio_deviation * found.found.diffusion_ratio_deviation;
  if (std::isfinite(square) && square > 0 && log_diffusion_ratio > kSure * std::sqrt(square))
    all.push_back(
        formatted("The measurements contradict the stated D, %.3g cm^2/s, which is said to be "
                  "known to %.2g %%. The value from both is %.3g cm^2/s.",
                  base.diffusion_cm2_s, 100 * found.diffusion_ratio_doubt, D));
  if (found.finding == selection::Finding::none && changes_diffusion_ratio(found.found) &&
      !std::isfinite(found.diffusion_ratio_doubt))
    all.push_back(
        "A different D can hide an effect, above all bulk-mobility. If D was measured, state it by "
        "--diffusion and --diffusion-error.");
  if (log_diffusion_ratio < std::log(selection::kFarDiffusionRatio) ||
      log_diffusion_ratio < kSure * found.found.diffusion_ratio_deviation)
    return;
  all.push_back(formatted(
      "The measurements need a D of %.2g cm^2/s. This is %.3g times %s than the model's D, %.2g "
      "cm^2/s. Are time_unit and the model's --diffusion right?",
      D, std::exp(log_diffusion_ratio), found.found.diffusion_ratio < 1 ? "smaller" : "larger",
      base.diffusion_cm2_s));
}

// D has a wider range than its interval where something else would change it, too.
void add_diffusion(const selection::Explanation& found, const physics::Units& base,
                   std::vector<std::string>& all) {
  if (const auto range = diffusion_range(found, base))
    all.push_back(formatted("D is between %.3g and %.3g cm^2/s: ", range->low, range->high) +
                  range->why + ".");
  if (!knows_diffusion(found) && !found.at_rest)
    all.push_back(found.finding == selection::Finding::not_identifiable
                      ? "The interval of D is not known: the best D may compensate for an effect "
                        "that these data would not show."
                      : "The interval of D is not known: the best D compensates for part of what "
                        "is missing.");
}

std::string text_of(const selection::ModelChange& change) {
  switch (change.reason) {
    case selection::ModelChange::replaced:
      return change.from + " explained most at first, but " + change.to + " explains more.";
    case selection::ModelChange::left_gap:
      return change.from + " explained most at first, but leaves a gap that " + change.to +
             " does not leave.";
    case selection::ModelChange::foretold:
      return change.from + " explained most at first, but with the held-out snapshots " +
             change.to + " is more probable.";
    case selection::ModelChange::is_none:
      return change.from + " was found at first, but " +
             (change.to.empty() ? std::string("with the noise of the model that contains it")
                                : "beside " + change.to) +
             " it is not significant.";
  }
  return "";
}

// The story of the search: what it thought of before.
void add_story(const selection::Explanation& found, std::vector<std::string>& all) {
  for (const selection::ModelChange& change : found.changes) {
    const auto is_from = [&](const selection::Excluded& t) { return t.effect == change.from; };
    const bool said = change.reason == selection::ModelChange::foretold &&
                      std::any_of(found.excluded.begin(), found.excluded.end(), is_from);
    if (!said) all.push_back(text_of(change));
  }
  for (const selection::Excluded& t : found.excluded)
    all.push_back(t.effect +
                  formatted(" explains the fitted snapshots about as well, but is less probable "
                            "with the held-out snapshot (difference of Schwarz' criterion: %.0f).",
                            -t.less));
}

// "4.1 nPa s m (2.9 to 6.3)": the viscosity of a membrane that moves rafts as they were seen to
// move.
std::string viscosity_text(const selection::Refit& fit, const physics::Units& base) {
  constexpr double kKelvin = 298, kNoMembrane = 1e-3;  // nPa s m: a film of water of 1 nm has that
  const auto of_motion = [&](const std::string& name) {
    const std::vector<FoundParameter> all = found_parameters(fit, base);
    return *std::find_if(all.begin(), all.end(), [&](const FoundParameter& p) {
      return p.name == name && p.effect == "brownian-flow";
    });
  };
  const FoundParameter thermal = of_motion("thermal"), water = of_motion("water");
  const auto viscosity = [&](double value) {
    return selection::viscosity_of(value, water.value, kKelvin, found_units(base, fit));
  };
  const double width = statistics::kNormal95 * thermal.sigma.value_or(0),
               least = viscosity(thermal.value + width);
  const std::string at = formatted("At %.0f K it is ", kKelvin);
  if (viscosity(thermal.value) < kNoMembrane)
    return at + "faster than the water beside any membrane allows.";
  return at + "that of a membrane with a viscosity of " +
         formatted("%.2g nPa s m (", viscosity(thermal.value)) +
         (least < kNoMembrane ? "0" : formatted("%.2g", least)) + " to " +
         (width < thermal.value ? formatted("%.2g", viscosity(thermal.value - width)) : "any") +
         ").";
}

// Nobody can say where rafts go at random. Where they go far, what is left of it in second order
// looks like other effects.
void add_random(const selection::Explanation& found, const physics::Units& base,
                std::vector<std::string>& all) {
  constexpr double kFar = 1.5;
  const selection::Refit& fit = found.found;
  if (!fit.hypothesis.is_random()) return;
  const double expected = fit.expected.train, random = fit.random.train,
               without = std::sqrt(std::max(0.0, expected * expected - random * random));
  all.push_back(formatted("Random motion cannot be forecast, so the gap stays. What changes is the "
                          "gap to be expected: %.4g with this motion, %.4g without. ",
                          expected, without) +
                (base.scaled ? "" : viscosity_text(fit, base)));
  if (random > kFar * without)
    all.push_back(
        "Rafts move further between snapshots than these forecasts resolve. Effects that were "
        "found beside the random motion may be none. Shorter intervals would tell.");
}

// A strength that cannot be larger was wanted larger.
void add_ends(const selection::Explanation& found, const physics::Units& base,
              std::vector<std::string>& all) {
  for (const auto& part : found.found.hypothesis.parts) {
    const double a = part.coefficients.front();
    const assimilation::Candidate& own = part.candidate;
    if (own.directions > 1 || a == 0 || (a > own.least && a < own.most)) continue;
    const FoundParameter strength = parameters_of(own.term(part.coefficients), base)[own.parameter];
    all.push_back(own.name + " is as strong as the search allows, " + strength.name +
                  formatted(" %.4g", strength.value) +
                  ". Something similar but of another form may be missing.");
  }
}

// Members of a class that would have different D: what a measurement of D would decide.
void add_class(const selection::Explanation& found, const physics::Units& base,
               std::vector<std::string>& all) {
  if (found.finding != selection::Finding::ambiguous) return;
  const auto D = [&](const selection::Refit& fit) {
    return base.diffusion_cm2_s * fit.diffusion_ratio;
  };
  const auto differ = [](const selection::Refit& a, const selection::Refit& b) {
    return std::fabs(std::log(a.diffusion_ratio / b.diffusion_ratio)) >
           kSure * std::hypot(a.diffusion_ratio_deviation, b.diffusion_ratio_deviation);
  };
  std::vector<selection::Refit> members = found.rivals;
  members.push_back(found.found);
  const bool different =
      std::any_of(members.begin(), members.end(), [&](const selection::Refit& a) {
        return std::any_of(members.begin(), members.end(),
                           [&](const selection::Refit& b) { return differ(a, b); });
      });
  if (!different) return;
  std::string text = "The effects that these data do not separate need different D: " +
                     found.found.hypothesis.name() + formatted(" for %.3g cm^2/s", D(found.found));
  for (const selection::Refit& rival : found.rivals)
    text += ", " + rival.hypothesis.name() + formatted(" for %.3g", D(rival));
  all.push_back(
      text + ". " +
      (std::isfinite(found.diffusion_ratio_doubt)
           ? "A more precise D may decide between them."
           : "A measured D (--diffusion and --diffusion-error) may decide between them."));
}

void add_mesh(const selection::Explanation& found, std::vector<std::string>& all) {
  // Where the verdict itself asks for other data, another mesh would not decide.
  const bool noise_decides = found.finding == selection::Finding::not_identifiable;
  if (found.h_over_epsilon > selection::kCoarse)
    all.push_back(formatted("The mesh is coarse for these phase boundaries: h/epsilon = %.2g",
                            found.h_over_epsilon) +
                  (noise_decides ? "." : ". More --cells would make the verdict more certain."));
}

void add_rerun(const selection::Explanation& found, std::vector<std::string>& all) {
  if (!found.rerun) return;
  if (!found.rerun->failure.empty())
    all.push_back("The check on another mesh and by another integrator failed: " +
                  found.rerun->failure);
  else if (found.rerun->refutes())
    all.push_back("On another mesh and by another integrator " + found.found.hypothesis.name() +
                  " forecasts the measurements significantly worse than the base model. It is "
                  "therefore no explanation, though it came closest in the search.");
  else if (selection::is_named(found) && !found.rerun->confirms())
    all.push_back(
        "On another mesh and by another integrator, what was found forecasts the measurements no "
        "better than the base model, within noise. More snapshots would decide.");
  else if (selection::is_named(found) && !found.rerun->heldout())
    all.push_back(
        "With fewer than four snapshots none is held out. Forecasts of new snapshots were "
        "therefore not tested.");
  if (found.rerun->gap_p && found.finding != selection::Finding::unnamed)
    all.push_back(
        "The model's own mesh shows a gap that nothing explains. On another mesh and by another "
        "integrator it is not significant (p = " +
        formatted("%.2g; significant is a p below %.2g", *found.rerun->gap_p,
                  selection::kGapLevel * found.false_alarms) +
        "). It may be an error of the mesh: repeat with more --cells.");
  if (!found.rerun->gap_failure.empty())
    all.push_back(
        "A gap remains that nothing explains. The check of this gap on another mesh failed: " +
        found.rerun->gap_failure);
}

// Why nothing more was looked for.
std::string more_effects(const selection::Explanation& found) {
  const std::optional<double> last =
      found.rounds.size() > 1
          ? selection::shares_closed(found.rounds[found.rounds.size() - 2].without,
                                     found.rounds.back().without)
                .train
          : std::nullopt;
  if (last && *last < selection::kLeastProgress)
    return formatted(
        "Something is still missing. The search ended because its last round closed only %.0f %% "
        "of the remaining gap.",
        100 * std::max(0.0, *last));
  return "Something may still be missing. A larger --most-effects would search for it.";
}

}  // namespace

std::vector<std::string> remarks(const selection::Explanation& found, const physics::Units& base) {
  std::vector<std::string> all;
  if (found.outliers > 0)
    all.push_back(std::to_string(found.outliers) +
                  " values were left out, as they are far from all values around them.");
  if (found.noise_model.correlation.at_bound)
    all.push_back(
        formatted("Noise is correlated over %.2g R or more, the largest length that is tried. The "
                  "search may take a missing effect for noise, and noise for an effect.",
                  found.noise_model.correlation.length()));
  add_diffusion_ratio(found, base, all);
  add_story(found, all);
  add_random(found, base, all);
  add_ends(found, base, all);
  add_class(found, base, all);
  add_mesh(found, all);
  add_failures(found, all);
  if (!found.found.settled)
    all.push_back("The refit of the parameters ended before it converged fully.");
  const selection::Round& last = found.rounds.back();
  if (selection::is_named(found) && found.stopped.empty() && last.screening.p <= found.false_alarms)
    all.push_back(last.refits.empty() && last.failures.empty()
                      ? more_effects(found)
                      : "Something may still be missing, but too little to say what.");
  if (!found.at_rest) add_assumptions(found, base, all);
  add_rerun(found, all);
  return all;
}

std::vector<std::string> remarks_on(const selection::Explanation& found,
                                    const ExplainSetup& setup) {
  std::vector<std::string> all = setup.notes;
  if (!setup.request.blur_stated)
    all.push_back(
        "dataset.toml does not state the blur of the images (key blur; 0 for sharp images). The "
        "search takes boundaries that a microscope widens for physics.");
  for (std::string& remark : remarks(found, setup.configuration.units()))
    all.push_back(std::move(remark));
  add_diffusion(found, setup.configuration.units(), all);
  if (found.at_rest)
    add_rest(setup, all);
  else
    add_own(found, setup, all);
  add_registered(found, setup, all);
  for (const selection::FrameChange& change : found.frames) all.push_back(text_of(change, setup));
  if (const auto& without = setup.request.without; !without.empty())
    all.push_back("Left out of the search by --without: " + joined(without, ", ") + ".");
  return all;
}

}  // namespace traceraft::explain
