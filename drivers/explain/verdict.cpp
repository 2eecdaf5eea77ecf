#include "drivers/explain/verdict.hpp"

#include <algorithm>

#include "drivers/explain/remarks.hpp"
#include "drivers/explain/verdict_sentence.hpp"
#include "drivers/output/program.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft {
namespace {

// {effect.parameter: {value, sigma, unit}}, D without an effect.
Json parameters_json(const std::vector<FoundParameter>& found) {
  Json parameters = Json::object();
  for (const FoundParameter& p : found)
    parameters[(p.effect.empty() ? "" : p.effect + ".") + p.name] = {
        {"value", p.value}, {"sigma", number_or_null(p.sigma)}, {"unit", p.unit}};
  return parameters;
}

// Of each other member of the class, as it fits best.
Json rivals_json(const Explanation& found, const Units& base) {
  Json rivals = Json::array();
  if (!is_named(found)) return rivals;
  for (const Refit& fit : found.rivals)
    rivals.push_back({{"effect", fit.hypothesis.name()},
                      {"parameters", parameters_json(found_parameters(fit, base))}});
  return rivals;
}

Json excluded_json(const Explanation& found) {
  Json all = Json::array();
  for (const Excluded& t : found.excluded)
    all.push_back({{"effect", t.effect}, {"score", -t.less}});
  return all;
}

Json bounds_json(const Explanation& found, const Units& base) {
  Json bounds = Json::object();
  for (const FoundBound& b : found_bounds(found, base))
    bounds[b.effect + "." + b.name] = {{"low", b.seen ? Json(b.low) : Json()},
                                       {"high", b.seen ? Json(b.high) : Json()},
                                       {"unit", b.unit}};
  return bounds;
}

Json alternatives_json(const std::vector<Verdict::Alternative>& all) {
  Json alternatives = Json::array();
  for (const auto& [effect, score] : all)
    alternatives.push_back({{"effect", effect}, {"score", score}});
  return alternatives;
}

Json gap_json(const Gaps& gaps) {
  return {{"train", gaps.train > 0 ? Json(gaps.train) : Json()},
          {"heldout", gaps.heldout > 0 ? Json(gaps.heldout) : Json()}};
}

Json closed_json(const Explanation& found) {
  if (found.found.hypothesis.added() == 0) return {};
  const SharesClosed closed = shares_closed(found.base.gap, found.found.gap, found.found.expected);
  return {{"train", number_or_null(closed.train)}, {"heldout", number_or_null(closed.heldout)}};
}

Json where_json(const Explanation& found, const ExplainSetup& setup) {
  if (found.disagreements.empty()) return {};
  const Disagreement& most = found.disagreements.front();
  return {{"vesicle", parse_number("vesicle", setup.series[most.vesicle].vesicle)},
          {"time", most.time * setup.configuration.units().seconds_per_unit()},
          {"region", {most.direction[0], most.direction[1], most.direction[2]}},
          {"state", most.state}};
}

Json rounds_json(const Explanation& found) {
  const bool held_out = found.base.gap.heldout > 0;
  Json rounds = Json::array();
  if (found.at_rest) return rounds;
  for (const Round& round : found.rounds) {
    const auto& scores = round.screening.scores;
    rounds.push_back({{"known", round.known.hypothesis.name()},
                      {"candidate", scores.empty() ? Json() : Json(scores.front().effect)},
                      {"p", round.screening.p},
                      {"gap_p", round.screening.gap_p},
                      {"gap_p_train", round.screening.train_gap_p},
                      {"gap_p_heldout", held_out ? Json(round.screening.heldout_gap_p) : Json()},
                      {"mesh_error", round.screening.mesh_error}});
  }
  return rounds;
}

Json rerun_json(const Explanation& found) {
  if (!found.rerun) return {};
  const Rerun& rerun = *found.rerun;
  const bool compared = found.found.hypothesis.added() > 0;
  const auto text = [](const std::string& why) { return why.empty() ? Json() : Json(why); };
  const bool told = compared && (rerun.heldout() || !rerun.failure.empty());
  return {{"confirms", told ? Json(rerun.confirms()) : Json()},
          {"refutes", compared ? Json(rerun.refutes()) : Json()},
          {"failure", text(rerun.failure)},
          {"gain", told && rerun.failure.empty() ? Json(rerun.gain) : Json()},
          {"gap_p", number_or_null(rerun.gap_p)},
          {"gap_failure", text(rerun.gap_failure)},
          {"cells", rerun.cells},
          {"integrator", rerun.integrator},
          {"base", gap_json(rerun.base)},
          {"named", gap_json(rerun.found)},
          {"floor", gap_json(rerun.floor)}};
}

Json range_json(const Explanation& found, const Units& base) {
  const std::optional<DiffusionRange> range = diffusion_range(found, base);
  if (!range) return {};
  return {{"low", range->low}, {"high", range->high}, {"why", range->why}};
}

// Length in R.
Json noise_json(const Explanation& found) {
  const NoiseCorrelation& shared = found.noise_model.correlation;
  return {{"level", found.noise},
          {"share", shared.share()},
          {"length", shared.white() ? Json() : Json(shared.length())},
          {"at_bound", shared.at_bound},
          {"error", shared.error}};
}

Json data_json(const ExplainSetup& setup) {
  const double radius = setup.configuration.units().length();
  const ExplainRequest& request = setup.request;
  Json snapshots = Json::array();
  for (const FieldSeries& vesicle : setup.series) snapshots.push_back(vesicle.snapshots.size());
  return {{"name", setup.name},
          {"kind", setup.synthetic ? "synthetic" : "measured"},
          {"radius_um", radius},
          {"blur_um", request.blur_stated ? Json(request.filter.blur * radius) : Json()},
          {"snapshots", snapshots}};
}

}  // namespace

std::vector<std::string> not_looked_for(const Explanation& found) {
  const std::vector<Candidate>& looked_for = found.rounds.front().known.screened;
  std::vector<std::string> names;
  for (const std::string& name : effects().names())
    if (std::none_of(looked_for.begin(), looked_for.end(),
                     [&](const Candidate& candidate) { return candidate.effect == name; }) &&
        !found.rounds.front().known.hypothesis.has(name))
      names.push_back(name);
  return names;
}

Verdict verdict_of(const Explanation& found, const ExplainSetup& setup) {
  const Configuration& model = setup.configuration;
  const Units base = model.units();
  const Round& first = found.rounds.front();
  Verdict verdict;
  verdict.finding = found.finding;
  verdict.members = class_of(found);
  verdict.closest = comes_closest(found);
  verdict.parameters = told_parameters(found, fit_shown(found), base);
  for (const Refit& fit : first.refits)
    verdict.alternatives.push_back({fit.hypothesis.name(), first.without.deviance - fit.deviance});
  verdict.base_gap = found.base.gap;
  verdict.named_gap = found.found.gap;
  verdict.runner_up_gap = runner_up(found).value_or(Gaps{});
  verdict.floor_gap = found.found.expected;
  verdict.replicates = setup.request.filter.replicates;
  verdict.false_alarms = found.false_alarms;
  if (!found.at_rest) verdict.p = first.screening.p;
  verdict.null_details = {{"rounds", rounds_json(found)}};
  verdict.details = {{"at_rest", found.at_rest},
                     {"diffusion_range", range_json(found, base)},
                     {"rivals", rivals_json(found, base)},
                     {"told_apart", excluded_json(found)},
                     {"bounds", bounds_json(found, base)},
                     {"not_looked_for", not_looked_for(found)},
                     {"closed", closed_json(found)},
                     {"rerun", rerun_json(found)},
                     {"where", where_json(found, setup)},
                     {"noise", noise_json(found)},
                     {"data", data_json(setup)},
                     {"model",
                      {{"epsilon_um", model.options().epsilon},
                       {"diffusion_cm2_s", base.diffusion_cm2_s},
                       {"effect", model.options().effect},
                       {"diffusion_error", found.pace_doubt},
                       {"cells", setup.request.cells},
                       {"h_over_epsilon", found.h_over_epsilon}}},
                     {"remarks", remarks_on(found, setup)}};
  return verdict;
}

Json verdict_json(const Verdict& verdict) {
  const std::vector<std::string>& members = verdict.members;
  Json json = {{"verdict", word_for(verdict.finding)},
               {"effect", members.empty() ? Json() : Json(members.front())},
               {"class", members},
               {"closest", verdict.closest.empty() ? Json() : Json(verdict.closest)},
               {"parameters", parameters_json(verdict.parameters)},
               {"alternatives", alternatives_json(verdict.alternatives)},
               {"gap",
                {{"base", gap_json(verdict.base_gap)},
                 {"named", gap_json(verdict.named_gap)},
                 {"placebo", gap_json(verdict.runner_up_gap)},
                 {"floor", gap_json(verdict.floor_gap)}}},
               {"null",
                {{"replicates", verdict.replicates},
                 {"false_alarm_level", verdict.false_alarms},
                 {"p", number_or_null(verdict.p)}}}};
  json["null"].update(verdict.null_details);
  json.update(verdict.details);
  json["program"] = program_text();
  return json;
}

}  // namespace traceraft
