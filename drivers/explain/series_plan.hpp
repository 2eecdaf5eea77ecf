// The effects that series are asked for, at the strengths at which they are simulated.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "drivers/ensemble/ensemble_point.hpp"
#include "kernel/effects/effects.hpp"
#include "verification/statistics/power_law.hpp"

namespace traceraft::explain {

// An effect at one strength, or at several that grow. All parameters but one stay the same.
struct PlannedEffect {
  std::vector<effects::EffectTerm> levels;
  std::size_t typical = 0;  // the level at which it is asked how many vesicles would show it

  const std::string& effect() const { return levels.front().effect; }
  std::size_t sought() const;  // index of the parameter that differs, a strength
  double strength(std::size_t level) const { return levels[level].values[sought()]; }
};

struct SeriesPlanRequest {
  statistics::Window looks;  // s
  int threads;
  std::vector<std::string> without;  // effects
  double kelvin;                     // temperature of Brownian motion
  // Simulates some vesicles with an effect, or with none, in a folder of that name.
  std::function<ensemble::PointEnd(const std::string& folder, const effects::EffectTerm*)> simulate;
  std::function<void(const std::string& step)> tell;
};

// Finds the strengths, each once: they are kept in strengths.json of the folder. Those of a field
// change c by 6 % of its standard deviation from one of five looks to the next, on a coarser mesh.
// Those of discs change the logarithms of what is seen at five looks by 0.2. Brownian motion has
// levels for all viscosities of membranes. Nothing: a signal to stop came. Throws InputError if no
// effect is left, or if the folder is for another model or for other looks.
std::optional<std::vector<PlannedEffect>> plan_effects(const std::filesystem::path& folder,
                                                       const config::Configuration& model,
                                                       const SeriesPlanRequest& request);

// The looks that the strengths in a folder are for. Throws InputError if they are of another model
// or of an earlier version.
statistics::Window planned_looks(const std::filesystem::path& folder,
                                 const config::Configuration& model);
bool has_plan(const std::filesystem::path& folder);

// The model with an effect until t_end (s).
config::Configuration ensemble_model(const config::Configuration& model, const std::string& effect,
                                     double t_end);

}  // namespace traceraft::explain
