#include "drivers/explain/explain_report.hpp"

#include <cmath>
#include <cstdio>

#include "drivers/config/config_file.hpp"
#include "drivers/output/json_file.hpp"
#include "drivers/output/text_table.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft {
namespace {

// Names and units of the parameters that a candidate's coefficients decide.
struct FoundParameter {
  std::string effect, name, unit;
  double value, sigma;
};

// Times of the found model are in units of R²/(pace D).
Units found_units(Units units, const Refit& fit) {
  units.diffusion_cm2_s *= fit.pace;
  return units;
}

// Errors of the coefficients, carried on to the parameters by differences.
std::vector<FoundParameter> found_parameters(const Refit& fit, const Units& base_units) {
  const Units units = found_units(base_units, fit);
  std::vector<FoundParameter> result;
  Eigen::Index first = 0;
  for (const auto& part : fit.hypothesis.parts) {
    const int n = part.candidate.directions;
    const std::vector<double> values = part.candidate.term(part.coefficients).values;
    const auto& specs = effects().find(part.candidate.effect).parameters;
    for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
      Vec slope(n);
      for (int d = 0; d < n; ++d) {
        std::vector<double> moved = part.coefficients;
        const double step = 1e-4 * std::max(part.candidate.step, std::fabs(moved[d]));
        moved[d] += step;
        slope[d] = (part.candidate.term(moved).values[k] - values[k]) / step;
      }
      const double variance = slope.dot(fit.covariance.block(first, first, n, n) * slope);
      const double factor = 1 / to_model_units(specs[k].unit, units);
      result.push_back({part.candidate.effect, specs[k].name, specs[k].unit, factor * values[k],
                        factor * std::sqrt(std::max(0.0, variance))});
    }
    first += n;
  }
  return result;
}

Json gap_json(const Gaps& gaps, bool held_out) {
  return {{"train", gaps.train}, {"heldout", held_out ? Json(gaps.heldout) : Json()}};
}

Configuration found_model(const Explanation& found, GivenValues model) {
  const Units units = Configuration(model, {}).units();
  const Units now = found_units(units, found.found);
  model["diffusion"] = {format_number(now.diffusion_cm2_s), "--diffusion"};
  model["effect"] = {effect_text(found.found.hypothesis, now), "--effect"};
  return {model, {}};
}

Json verdict_json(const Explanation& found, const Units& units) {
  const bool named = !found.found.hypothesis.parts.empty();
  Json parameters = Json::object();
  for (const FoundParameter& p : found_parameters(found.found, units))
    parameters[p.effect + "." + p.name] = {
        {"value", p.value}, {"sigma", p.sigma}, {"unit", p.unit}};
  const double D = units.diffusion_cm2_s * found.found.pace;
  parameters["diffusion"] = {
      {"value", D}, {"sigma", D * found.found.pace_deviation}, {"unit", "cm^2/s"}};
  Json alternatives = Json::array();
  for (const Refit& refit : found.rounds.front().refits)
    alternatives.push_back({{"effect", refit.hypothesis.name()},
                            {"score", found.rounds.front().without.deviance - refit.deviance}});
  const bool held_out = found.base_gap.heldout > 0 || found.found_gap.heldout > 0;
  Json where;
  if (!found.disagreements.empty()) {
    const Disagreement& most = found.disagreements.front();
    where = {{"time", most.time * units.seconds_per_unit()},
             {"region", {most.direction[0], most.direction[1], most.direction[2]}},
             {"state", most.state}};
  }
  Json rounds = Json::array();
  for (const Round& round : found.rounds)
    rounds.push_back({{"known", round.known.hypothesis.name()},
                      {"candidate", round.screening.scores.front().effect},
                      {"p", round.screening.p},
                      {"gap_p", round.screening.gap_p},
                      {"mesh_error", round.screening.mesh_error}});
  return {{"verdict", word_for(found.finding)},
          {"effect", named ? Json(found.found.hypothesis.name()) : Json()},
          {"class", found.equivalent},
          {"parameters", parameters},
          {"alternatives", alternatives},
          {"gap",
           {{"base", gap_json(found.base_gap, held_out)},
            {"named", gap_json(found.found_gap, held_out)},
            {"placebo", gap_json(found.placebo_gap, held_out)},
            {"floor", gap_json(found.floor, held_out)}}},
          {"where", where},
          {"null",
           {{"replicates", found.replicates},
            {"false_alarm_level", found.rounds.front().screening.p},
            {"rounds", rounds}}},
          {"noise", found.noise}};
}

Table scores_table(const Explanation& found) {
  Table table{"scores", {"round", "effect", "score", "of noise", "p", "response/noise"}, {}};
  for (std::size_t k = 0; k < found.rounds.size(); ++k)
    for (const CandidateScore& s : found.rounds[k].screening.scores)
      table.rows.push_back(
          {static_cast<double>(k + 1), s.effect, s.score, s.null_mean, s.p, s.response});
  return table;
}

Table disagreements_table(const Explanation& found, const Units& units) {
  Table table{"disagreements", {"time/s", "state", "x", "y", "z", "deviations", "p"}, {}};
  for (const Disagreement& d : found.disagreements)
    table.rows.push_back({d.time * units.seconds_per_unit(), d.state, d.direction[0],
                          d.direction[1], d.direction[2], d.z, d.p});
  return table;
}

std::string sentence(const Explanation& found) {
  const std::string name = found.found.hypothesis.name();
  switch (found.finding) {
    case Finding::none:
      return "No significant disagreement: the model explains the data within their noise.";
    case Finding::named:
      return "The model lacks " + name + ".";
    case Finding::ambiguous: {
      std::string others;
      for (std::size_t k = 1; k < found.equivalent.size(); ++k)
        others += (k > 1 ? ", " : "") + found.equivalent[k];
      return "The model lacks " + name + ", or in its place " + others +
             ": these data do not tell them apart.";
    }
    case Finding::below_resolution:
      return "There is a disagreement, but the mesh of the model changes c as much: "
             "repeat with more --cells.";
    case Finding::unnamed:
      return "There is a disagreement that no known effect explains" +
             (name.empty() ? std::string(".") : ", even with " + name + ".");
  }
  return "";
}

}  // namespace

std::string effect_text(const Hypothesis& hypothesis, const Units& units) {
  std::string text;
  for (const EffectTerm& term : hypothesis.terms()) {
    const auto& specs = effects().find(term.effect).parameters;
    text += (text.empty() ? "" : "; ") + term.effect;
    for (std::size_t k = 0; k < specs.size(); ++k)
      text += (k ? "," : ":") + specs[k].name + "=" +
              format_number(term.values[k] / to_model_units(specs[k].unit, units));
  }
  return text;
}

void write_explanation(const std::filesystem::path& folder, const Explanation& found,
                       const GivenValues& model) {
  const Units units = Configuration(model, {}).units();
  write_durably(folder / "scores.csv", csv_text(scores_table(found)));
  write_durably(folder / "disagreements.csv", csv_text(disagreements_table(found, units)));
  if (!found.found.hypothesis.parts.empty())
    write_durably(folder / "model.toml", config_text(found_model(found, model)));
  write_durably(folder / "verdict.json", verdict_json(found, units).dump(2) + "\n");
}

void print_explanation(const Explanation& found, const GivenValues& model) {
  const Units units = Configuration(model, {}).units();
  std::printf("\n%s\n\n", sentence(found).c_str());
  std::vector<Row> rows{{"parameter", "value", "+-", "unit"}};
  for (const FoundParameter& p : found_parameters(found.found, units))
    rows.push_back({p.effect + " " + p.name, formatted("%.4g", p.value),
                    formatted("%.2g", 1.96 * p.sigma), p.unit});
  const double D = units.diffusion_cm2_s * found.found.pace;
  rows.push_back({"diffusion", formatted("%.4g", D),
                  formatted("%.2g", 1.96 * D * found.found.pace_deviation), "cm^2/s"});
  print_rows(rows);
  std::printf("\n");
  const auto gap = [](const char* name, const Gaps& g) {
    return Row{name, formatted("%.4f", g.train), g.heldout > 0 ? formatted("%.4f", g.heldout) : ""};
  };
  print_rows({{"gap in c", "fitted", "held out"},
              gap("base model", found.base_gap),
              gap("what was found", found.found_gap),
              gap("second best", found.placebo_gap),
              gap("if nothing is missing", found.floor)});
  std::printf(
      "\nnoise of the measurements %.4f; %zu significant disagreements with the base model\n",
      found.noise, found.disagreements.size());
}

}  // namespace traceraft
