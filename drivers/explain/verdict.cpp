#include "drivers/explain/verdict.hpp"

#include <algorithm>

#include "drivers/explain/remarks.hpp"
#include "drivers/explain/verdict_sentence.hpp"
#include "drivers/output/program.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft::explain {
namespace {

// {effect.parameter: {value, sigma, unit}}, D without an effect.
input::Json parameters_json(const std::vector<FoundParameter>& found) {
  input::Json parameters = input::Json::object();
  for (const FoundParameter& p : found)
    parameters[(p.effect.empty() ? "" : p.effect + ".") + p.name] = {
        {"value", p.value}, {"sigma", input::number_or_null(p.sigma)}, {"unit", p.unit}};
  return parameters;
}

// The effect and the parameters of each other member of the class, as it fits best.
input::Json rivals_json(const selection::Explanation& found, const physics::Units& base) {
  input::Json rivals = input::Json::array();
  if (!selection::is_named(found)) return rivals;
  for (const selection::Refit& fit : found.rivals)
    rivals.push_back({{"effect", fit.hypothesis.name()},
                      {"parameters", parameters_json(found_parameters(fit, base))}});
  return rivals;
}

input::Json excluded_json(const selection::Explanation& found) {
  input::Json all = input::Json::array();
  for (const selection::Excluded& t : found.excluded)
    all.push_back({{"effect", t.effect}, {"score", -t.less}});
  return all;
}

input::Json bounds_json(const selection::Explanation& found, const physics::Units& base) {
  input::Json bounds = input::Json::object();
  for (const FoundBound& b : found_bounds(found, base))
    bounds[b.effect + "." + b.name] = {{"low", b.seen ? input::Json(b.low) : input::Json()},
                                       {"high", b.seen ? input::Json(b.high) : input::Json()},
                                       {"unit", b.unit}};
  return bounds;
}

input::Json alternatives_json(const std::vector<Verdict::Alternative>& all) {
  input::Json alternatives = input::Json::array();
  for (const auto& [effect, score] : all)
    alternatives.push_back({{"effect", effect}, {"score", score}});
  return alternatives;
}

input::Json gap_json(const assimilation::Gaps& gaps) {
  return {{"train", gaps.train > 0 ? input::Json(gaps.train) : input::Json()},
          {"heldout", gaps.heldout > 0 ? input::Json(gaps.heldout) : input::Json()}};
}

input::Json closed_json(const selection::Explanation& found) {
  if (found.found.hypothesis.added() == 0) return {};
  const assimilation::SharesClosed closed = selection::shares_closed(found.base, found.found);
  return {{"train", input::number_or_null(closed.train)},
          {"heldout", input::number_or_null(closed.heldout)}};
}

input::Json where_json(const selection::Explanation& found, const ExplainSetup& setup) {
  if (found.disagreements.empty()) return {};
  const assimilation::Disagreement& most = found.disagreements.front();
  return {{"vesicle", parse_number("vesicle", setup.series[most.vesicle].vesicle)},
          {"time", most.time * setup.configuration.units().seconds_per_unit()},
          {"region", {most.direction[0], most.direction[1], most.direction[2]}},
          {"state", most.state}};
}

input::Json rounds_json(const selection::Explanation& found) {
  const bool held_out = found.base.gap.heldout > 0;
  input::Json rounds = input::Json::array();
  if (found.at_rest) return rounds;
  for (const selection::Round& round : found.rounds) {
    const auto& scores = round.screening.scores;
    rounds.push_back(
        {{"known", round.known.hypothesis.name()},
         {"candidate", scores.empty() ? input::Json() : input::Json(scores.front().effect)},
         {"p", round.screening.p},
         {"gap_p", round.screening.gap_p},
         {"gap_p_train", round.screening.train_gap_p},
         {"gap_p_heldout", held_out ? input::Json(round.screening.heldout_gap_p) : input::Json()},
         {"mesh_error", round.screening.mesh_error}});
  }
  return rounds;
}

input::Json rerun_json(const selection::Explanation& found) {
  if (!found.rerun) return {};
  const selection::Rerun& rerun = *found.rerun;
  const bool compared = found.found.hypothesis.added() > 0;
  const auto text = [](const std::string& why) {
    return why.empty() ? input::Json() : input::Json(why);
  };
  const bool told = compared && (rerun.heldout() || !rerun.failure.empty());
  return {{"confirms", told ? input::Json(rerun.confirms()) : input::Json()},
          {"refutes", compared ? input::Json(rerun.refutes()) : input::Json()},
          {"failure", text(rerun.failure)},
          {"gain", told && rerun.failure.empty() ? input::Json(rerun.gain) : input::Json()},
          {"gap_p", input::number_or_null(rerun.gap_p)},
          {"gap_failure", text(rerun.gap_failure)},
          {"cells", rerun.cells},
          {"integrator", rerun.integrator},
          {"base", gap_json(rerun.base)},
          {"named", gap_json(rerun.found)},
          {"floor", gap_json(rerun.floor)}};
}

input::Json range_json(const selection::Explanation& found, const physics::Units& base) {
  const std::optional<DiffusionRange> range = diffusion_range(found, base);
  if (!range) return {};
  return {{"low", range->low}, {"high", range->high}, {"why", range->why}};
}

// Length in R.
input::Json noise_json(const selection::Explanation& found) {
  const assimilation::NoiseCorrelation& shared = found.noise_model.correlation;
  return {{"level", found.noise},
          {"share", shared.share()},
          {"length", shared.white() ? input::Json() : input::Json(shared.length())},
          {"at_bound", shared.at_bound},
          {"error", shared.error}};
}

input::Json data_json(const ExplainSetup& setup) {
  const double radius = setup.configuration.units().length();
  const selection::ExplainRequest& request = setup.request;
  input::Json snapshots = input::Json::array();
  for (const assimilation::FieldSeries& vesicle : setup.series)
    snapshots.push_back(vesicle.snapshots.size());
  return {
      {"name", setup.name},
      {"kind", setup.synthetic ? "synthetic" : "measured"},
      {"radius_um", radius},
      {"blur_um", request.blur_stated ? input::Json(request.filter.blur * radius) : input::Json()},
      {"snapshots", snapshots}};
}

}  // namespace

std::vector<std::string> not_looked_for(const selection::Explanation& found) {
  const std::vector<assimilation::Candidate>& looked_for = found.rounds.front().known.screened;
  std::vector<std::string> names;
  for (const std::string& name : effects::effects().names())
    if (std::none_of(
            looked_for.begin(), looked_for.end(),
            [&](const assimilation::Candidate& candidate) { return candidate.name == name; }) &&
        !found.rounds.front().known.hypothesis.has(name))
      names.push_back(name);
  return names;
}

Verdict verdict_of(const selection::Explanation& found, const ExplainSetup& setup) {
  const config::Configuration& model = setup.configuration;
  const physics::Units base = model.units();
  const selection::Round& first = found.rounds.front();
  Verdict verdict;
  verdict.finding = found.finding;
  verdict.members = selection::class_of(found);
  verdict.closest = comes_closest(found);
  verdict.parameters = told_parameters(found, fit_shown(found), base);
  for (const selection::Refit& fit : first.refits)
    verdict.alternatives.push_back({fit.hypothesis.name(), first.without.deviance - fit.deviance});
  verdict.base_gap = found.base.gap;
  verdict.named_gap = found.found.gap;
  verdict.runner_up_gap = selection::runner_up(found).value_or(assimilation::Gaps{});
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
                       {"diffusion_error", found.diffusion_ratio_doubt},
                       {"cells", setup.request.cells},
                       {"h_over_epsilon", found.h_over_epsilon}}},
                     {"remarks", remarks_on(found, setup)}};
  return verdict;
}

input::Json verdict_json(const Verdict& verdict) {
  const std::vector<std::string>& members = verdict.members;
  input::Json json = {
      {"verdict", selection::word_for(verdict.finding)},
      {"effect", members.empty() ? input::Json() : input::Json(members.front())},
      {"class", members},
      {"closest", verdict.closest.empty() ? input::Json() : input::Json(verdict.closest)},
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
        {"p", input::number_or_null(verdict.p)}}}};
  json["null"].update(verdict.null_details);
  json.update(verdict.details);
  json["program"] = output::program_text();
  return json;
}

}  // namespace traceraft::explain
