#include "drivers/explain/found_parameters.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "kernel/effects/effects.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::explain {
physics::Units found_units(physics::Units units, const selection::Refit& fit) {
  units.diffusion_cm2_s *= fit.diffusion_ratio;
  return units;
}

namespace {

// Errors of the coefficients, carried on to the parameters by differences. That of the strength,
// beside coefficients that are held at the end of their range.
double variance_of(const assimilation::Hypothesis::Part& part, std::size_t parameter,
                   const Eigen::MatrixXd& covariance) {
  const double value = part.candidate.term(part.coefficients).values[parameter];
  Vec slope(part.candidate.directions);
  const auto held = [&](double a) { return a <= part.candidate.least || a >= part.candidate.most; };
  const bool all_held = std::all_of(part.coefficients.begin(), part.coefficients.end(), held);
  for (int d = 0; d < part.candidate.directions; ++d) {
    std::vector<double> moved = part.coefficients;
    if (parameter == part.candidate.parameter && held(moved[d]) && !all_held) {
      slope[d] = 0;
      continue;
    }
    const double step = 1e-4 * std::max(part.candidate.step, std::fabs(moved[d]));
    moved[d] += step;
    slope[d] = (part.candidate.term(moved).values[parameter] - value) / step;
  }
  return std::max(0.0, slope.dot(covariance * slope));
}

}  // namespace

std::vector<FoundParameter> parameters_of(const effects::EffectTerm& term,
                                          const physics::Units& units) {
  const auto& specs = effects::effects().find(term.effect).parameters;
  std::vector<FoundParameter> result;
  for (std::size_t k = 0; k < specs.size(); ++k)
    result.push_back({term.effect, specs[k].name, specs[k].unit,
                      term.values[k] / effects::to_model_units(specs[k].unit, units),
                      std::nullopt});
  return result;
}

const selection::Refit& fit_shown(const selection::Explanation& found) {
  return selection::is_named(found) || found.finding == selection::Finding::unnamed ? found.found
                                                                                    : found.base;
}

std::vector<FoundParameter> found_parameters(const selection::Refit& fit,
                                             const physics::Units& base) {
  const physics::Units units = found_units(base, fit);
  std::vector<FoundParameter> result;
  Eigen::Index first = 0;
  for (const auto& part : fit.hypothesis.parts) {
    const int n = part.candidate.directions;
    const effects::EffectTerm term = part.candidate.term(part.coefficients);
    std::vector<FoundParameter> own = parameters_of(term, units);
    for (FoundParameter& p : own) p.effect = part.candidate.name;
    for (std::size_t k = part.candidate.parameter, end = k + static_cast<std::size_t>(n); k < end;
         ++k)
      own[k].sigma = std::sqrt(variance_of(part, k, fit.covariance.block(first, first, n, n))) /
                     effects::to_model_units(own[k].unit, units);
    const std::vector<ParameterSpec>& specs = effects::effects().find(term.effect).parameters;
    for (std::size_t k = 0; k < own.size(); ++k)
      if (own[k].sigma || (effects::is_used(term, k) && specs[k].kind != ParameterKind::integer))
        result.push_back(own[k]);
    first += n;
  }
  const double D = units.diffusion_cm2_s;
  result.push_back({"", "diffusion", "cm^2/s", D, D * fit.diffusion_ratio_deviation});
  return result;
}

bool knows_diffusion(const selection::Explanation& found) {
  return found.finding == selection::Finding::none || selection::is_named(found);
}

std::vector<FoundParameter> told_parameters(const selection::Explanation& found,
                                            const selection::Refit& fit,
                                            const physics::Units& base) {
  if (found.at_rest) return {};
  std::vector<FoundParameter> all = found_parameters(fit, base);
  if (!knows_diffusion(found)) all.back().sigma.reset();
  return all;
}

namespace {

// The range that holds the intervals of all members of a class.
DiffusionRange range_of_class(const selection::Explanation& found, double D) {
  std::vector<selection::Refit> members = found.rivals;
  members.push_back(found.found);
  DiffusionRange range{HUGE_VAL, 0, "it covers the intervals of all members of the class"};
  for (const selection::Refit& fit : members) {
    const double width = std::exp(statistics::kNormal95 * fit.diffusion_ratio_deviation);
    range.low = std::min(range.low, D * fit.diffusion_ratio / width);
    range.high = std::max(range.high, D * fit.diffusion_ratio * width);
  }
  return range;
}

// Known is one number, D (1 + slope · strength): the more of the effect, the less of D.
DiffusionRange range_beside(const selection::ConfoundedWithDiffusionRatio& confounded,
                            const selection::Refit& fit, double D) {
  const double most = assimilation::find_candidate(confounded.effect)->most;
  const double width = std::exp(statistics::kNormal95 * fit.diffusion_ratio_deviation),
               known = D * fit.diffusion_ratio;
  return {known / width / (1 + confounded.slope * most), known * width,
          formatted("these data determine D (1 + %.3g s) = %.4g, where s is the strength of %s; "
                    "the interval of D above is that without it",
                    confounded.slope, known, confounded.effect.c_str())};
}

}  // namespace

std::optional<DiffusionRange> diffusion_range(const selection::Explanation& found,
                                              const physics::Units& base) {
  const double D = base.diffusion_cm2_s;
  if (found.finding == selection::Finding::ambiguous) return range_of_class(found, D);
  if (!knows_diffusion(found) || found.rounds.empty() || std::isfinite(found.diffusion_ratio_doubt))
    return {};
  const std::vector<selection::ConfoundedWithDiffusionRatio>& confounded =
      found.rounds.back().screening.confounded;
  if (confounded.empty()) return {};
  return range_beside(confounded.front(), found.found, D);
}

std::vector<FoundBound> found_bounds(const selection::Explanation& found,
                                     const physics::Units& base) {
  const physics::Units units = found_units(base, found.found);
  std::vector<FoundBound> result;
  for (const selection::Bound& bound : selection::bounds_of(found)) {
    const assimilation::Candidate candidate = *assimilation::find_candidate(bound.effect);
    const ParameterSpec& spec =
        effects::effects().find(assimilation::effect_of(candidate)).parameters[candidate.parameter];
    const double factor = 1 / effects::to_model_units(spec.unit, units);
    result.push_back(
        {bound.effect, spec.name, spec.unit, factor * bound.low, factor * bound.high, bound.seen});
  }
  return result;
}

config::GivenValues found_model(const selection::Explanation& found, config::GivenValues model) {
  const physics::Units units = config::Configuration(model, {}).units();
  const physics::Units now = found_units(units, found.found);
  model["diffusion"] = {format_number(now.diffusion_cm2_s), "--diffusion"};
  std::vector<effects::EffectTerm> terms;
  for (const assimilation::Hypothesis::Part& part : found.found.hypothesis.parts) {
    const effects::EffectTerm term = part.candidate.term(part.coefficients);
    if (term.values[part.candidate.parameter] != 0) terms.push_back(term);
  }
  if (!terms.empty()) model["effect"] = {effect_text(terms, now), "--effect"};
  return model;
}

std::string effect_text(const std::vector<effects::EffectTerm>& terms,
                        const physics::Units& units) {
  std::string text;
  for (const effects::EffectTerm& term : terms) {
    text += (text.empty() ? "" : "; ") + term.effect;
    const char* before = ":";
    const std::vector<FoundParameter> parameters = parameters_of(term, units);
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      if (!effects::is_used(term, k)) continue;
      text += before + parameters[k].name + "=" + format_number(parameters[k].value);
      before = ",";
    }
  }
  return text;
}

}  // namespace traceraft::explain
