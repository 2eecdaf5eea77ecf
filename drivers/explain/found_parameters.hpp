// The parameters that a search has found, in the units of its user.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "verification/selection/search/explanation.hpp"

namespace traceraft::explain {

struct FoundParameter {
  std::string effect, name, unit;
  double value;
  std::optional<double> sigma;  // none: it was assumed, not found
};

// Times of a found model are in units of R²/(its D).
physics::Units found_units(physics::Units base, const selection::Refit& fit);

// All parameters of an effect, in their own units and without sigma.
std::vector<FoundParameter> parameters_of(const effects::EffectTerm& term,
                                          const physics::Units& units);

// Whose parameters are told: what was refuted has none.
const selection::Refit& fit_shown(const selection::Explanation& found);

// Parameters of a model's effects, then D (effect "").
std::vector<FoundParameter> found_parameters(const selection::Refit& fit,
                                             const physics::Units& base);

// The parameters as a verdict tells them. Where something is missing that has no name D has no
// error: it makes up for what is missing, and nobody knows by how much.
std::vector<FoundParameter> told_parameters(const selection::Explanation& found,
                                            const selection::Refit& fit,
                                            const physics::Units& base);
bool knows_diffusion(const selection::Explanation& found);

// D between these, in cm²/s with 95 % confidence, whatever these data cannot tell from it: the
// members of a class, or an effect that D makes up for, within its range. Nothing where D is not
// known at all, or where nothing is confounded with it.
struct DiffusionRange {
  double low, high;
  std::string why;  // a sentence
};
std::optional<DiffusionRange> diffusion_range(const selection::Explanation& found,
                                              const physics::Units& base);

// The bounds of the first parameter of an effect that was not found, with 95 % confidence.
struct FoundBound {
  std::string effect, name, unit;
  double low, high;
  bool seen;
};
std::vector<FoundBound> found_bounds(const selection::Explanation& found,
                                     const physics::Units& base);

// The model with the effects and the diffusion that were found, as `traceraft run --config` takes
// it. `model`: with the radius of the vesicle.
config::GivenValues found_model(const selection::Explanation& found, config::GivenValues model);

// Effects as --effect takes them.
std::string effect_text(const std::vector<effects::EffectTerm>& terms, const physics::Units& units);

}  // namespace traceraft::explain
