#include "drivers/explain/series_verdict.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/explain/extended_model.hpp"
#include "drivers/explain/series_strength.hpp"
#include "drivers/output/program.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft::explain {
namespace {

input::Json number_or_null(const std::optional<double>& number) {
  return number ? input::Json(*number) : input::Json();
}

// In D, the inverse of the unit.
input::Json range_json(const config::Configuration& model, const selection::UnitRange& range) {
  const auto bound = [&](double ln_unit, bool open) {
    return open ? input::Json() : input::Json(units_of(model, ln_unit).diffusion_cm2_s);
  };
  return {{"low", bound(range.high, range.high_open)},
          {"low_by", range.high_by},
          {"high", bound(range.low, range.low_open)},
          {"high_by", range.low_by}};
}

input::Json scores_json(const config::Configuration& model, const SeriesEnsembles& ensembles,
                        const selection::SeriesExplanation& found) {
  input::Json scores = input::Json::array();
  for (const selection::SeriesScore& s : found.scores) {
    const ToldStrength told = told_strength(model, ensembles, s);
    input::Json assumed = input::Json::object();
    for (const FoundParameter& p : assumed_parameters(model, ensembles, s))
      assumed[p.name] = {{"value", p.value}, {"unit", p.unit}};
    scores.push_back({{"effect", s.effect},
                      {"score", s.gain},
                      {"null_mean", s.null_mean},
                      {"p", s.p},
                      {"trend_p", s.trend_p},
                      {"parameter", told.parameter},
                      {"value", told.value},
                      {"sigma", told.sigma},
                      {"low", number_or_null(told.low)},
                      {"high", number_or_null(told.high)},
                      {"unit", told.unit},
                      {"assumed", assumed},
                      {"vesicles_needed", s.vesicles},
                      {"shown_by", observations::name_of(s.telling).id}});
  }
  return scores;
}

input::Json offsets_json(const std::vector<selection::SeriesOffset>& all) {
  input::Json offsets = input::Json::array();
  for (const selection::SeriesOffset& o : all)
    offsets.push_back({{"quantity", observations::name_of(o.quantity).id},
                       {"of", "ln"},
                       {"level", o.level},
                       {"level_deviations", o.level_deviations},
                       {"slope", o.slope},
                       {"slope_deviations", o.slope_deviations}});
  return offsets;
}

// The parameters of the effect that explains most, if something was named, and D.
std::vector<FoundParameter> series_parameters(const config::Configuration& model,
                                              const SeriesEnsembles& ensembles,
                                              const selection::SeriesExplanation& found) {
  const selection::SeriesScore& best = found.scores.front();
  const double ln_unit = selection::is_named(found.finding) ? best.ln_unit : found.base.ln_unit;
  std::vector<FoundParameter> result;
  if (selection::is_named(found.finding)) {
    const ToldStrength told = told_strength(model, ensembles, best);
    result.push_back({best.effect, told.parameter, told.unit, told.value, told.sigma});
    for (FoundParameter& p : assumed_parameters(model, ensembles, best))
      result.push_back(std::move(p));
  }
  const double D = units_of(model, ln_unit).diffusion_cm2_s;
  result.push_back({"", "diffusion", "cm^2/s", D,
                    selection::is_named(found.finding) ? std::nullopt
                                                       : std::optional(D * found.unit_deviation)});
  return result;
}

config::GivenValues named_model(config::GivenValues model, const SeriesEnsembles& ensembles,
                                const selection::SeriesExplanation& found) {
  const selection::SeriesScore& best = found.scores.front();
  const config::Configuration base(model, {});
  const physics::Units units = units_of(base, best.ln_unit);
  model["diffusion"] = {format_number(units.diffusion_cm2_s), "--diffusion"};
  model["effect"] = {effect_text({found_term(base, ensembles, best)}, units), "--effect"};
  return model;
}

}  // namespace

std::vector<std::string> class_of(const selection::SeriesExplanation& found) {
  std::vector<std::string> members;
  if (!selection::is_named(found.finding)) return members;
  const std::string& best = found.scores.front().effect;
  members.push_back(best);
  for (const auto& some : found.named)
    for (const std::string& effect : some)
      if (effect != best) members.push_back(effect);
  return members;
}

physics::Units found_units(const config::Configuration& model,
                           const selection::SeriesExplanation& found) {
  return units_of(model, found.base.ln_unit);
}

input::Json series_json(const config::Configuration& model, const SeriesEnsembles& ensembles,
                        const selection::SeriesExplanation& found,
                        const std::vector<PerimeterExponent>& laws) {
  const double D = found_units(model, found).diffusion_cm2_s;
  input::Json ties = input::Json::array(), exponents = input::Json::array();
  for (const selection::SeriesTie& tie : found.ties)
    ties.push_back({{"effect", tie.effect},
                    {"other", tie.other},
                    {"vesicles_needed", tie.vesicles},
                    {"shown_by", observations::name_of(tie.telling).id}});
  for (const PerimeterExponent& e : laws)
    exponents.push_back(
        {{"model", e.model}, {"b", e.law.law.b}, {"interval_95", {e.law.b.low, e.law.b.high}}});
  return {{"verdict", selection::word_for(found.finding)},
          {"class",
           selection::is_named(found.finding) ? input::Json(found.named) : input::Json::array()},
          {"p", found.p},
          {"trend_p", found.trend_p},
          {"vesicles", found.vesicles},
          {"looks", found.looks},
          {"diffusion",
           {{"value", D},
            {"sigma", D * found.unit_deviation},
            {"unit", "cm^2/s"},
            {"determined", found.unit_told && !found.unit_at_end}}},
          {"diffusion_range", range_json(model, found.unit_range)},
          {"offsets", offsets_json(found.offsets)},
          {"best_offsets", offsets_json(found.best_offsets)},
          {"scores", scores_json(model, ensembles, found)},
          {"classes", found.classes},
          {"ties", ties},
          {"simulations", ensembles.folder.string()},
          {"exponents", exponents},
          {"program", output::program_text()}};
}

Verdict verdict_of(const config::Configuration& model, const SeriesEnsembles& ensembles,
                   const selection::SeriesExplanation& found,
                   const selection::SeriesRequest& request) {
  Verdict verdict;
  verdict.finding = found.finding;
  verdict.members = class_of(found);
  if (found.finding == selection::Finding::unnamed && !found.named.empty())
    verdict.closest = found.named.front().front();
  verdict.parameters = series_parameters(model, ensembles, found);
  for (const selection::SeriesScore& s : found.scores)
    verdict.alternatives.push_back({s.effect, s.gain});
  verdict.replicates = request.replicates;
  verdict.false_alarms = request.false_alarms;
  verdict.p = found.p;
  verdict.null_details = {{"trend_p", found.trend_p}};
  verdict.details = {{"where", input::Json()}};
  return verdict;
}

void write_series_verdict(const std::filesystem::path& folder,
                          const std::filesystem::path& model_file, const config::GivenValues& model,
                          const SeriesEnsembles& ensembles,
                          const selection::SeriesExplanation& found,
                          const selection::SeriesRequest& request) {
  const config::Configuration base(model, {});
  if (selection::is_named(found.finding))
    write_extended_model(folder / "model.toml", model_file, named_model(model, ensembles, found),
                         "found by traceraft explain: " + found.scores.front().effect +
                             ", with D fitted together with it");
  input::write_json(folder / "verdict.json",
                    verdict_json(verdict_of(base, ensembles, found, request)));
}

}  // namespace traceraft::explain
