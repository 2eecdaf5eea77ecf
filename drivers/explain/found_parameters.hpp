// What a search has found, in the units of its user.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "verification/selection/search/explanation.hpp"

namespace traceraft {

struct FoundParameter {
  std::string effect, name, unit;
  double value;
  std::optional<double> sigma;  // none: it was assumed, not found
};

// All parameters of an effect, in their own units and without sigma.
std::vector<FoundParameter> parameters_of(const EffectTerm& term, const Units& units);

// Whose parameters are told: what was refuted has none.
const Refit& fit_shown(const Explanation& found);

// Parameters of a model's effects, then D (effect "").
std::vector<FoundParameter> found_parameters(const Refit& fit, const Units& base);

// As a verdict tells them. Where something is missing that has no name D has no error: it makes up
// for what is missing, and nobody knows by how much.
std::vector<FoundParameter> told_parameters(const Explanation& found, const Refit& fit,
                                            const Units& base);
bool knows_diffusion(const Explanation& found);

// D between these, in cm²/s with 95 % confidence, whatever these data cannot tell from it: the
// members of a class, or an effect that D makes up for, within its range. Nothing where D is not
// known at all, or where nothing is confounded with it.
struct DiffusionRange {
  double low, high;
  std::string why;  // a sentence
};
std::optional<DiffusionRange> diffusion_range(const Explanation& found, const Units& base);

// Of the first parameter of an effect that was not found, with 95 % confidence.
struct FoundBound {
  std::string effect, name, unit;
  double low, high;
  bool seen;
};
std::vector<FoundBound> found_bounds(const Explanation& found, const Units& base);

// The model with the effects and the diffusion that were found, as `traceraft run --config` takes
// it. `model`: with the radius of the vesicle.
GivenValues found_model(const Explanation& found, GivenValues model);

// Effects as --effect takes them.
std::string effect_text(const std::vector<EffectTerm>& terms, const Units& units);

}  // namespace traceraft
