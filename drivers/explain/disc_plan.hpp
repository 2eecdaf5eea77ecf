// The strengths of effects on rafts that are discs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/explain/series_plan.hpp"

namespace traceraft::explain {

// Effects that discs can have, and their strengths.
class DiscSizes {
 public:
  DiscSizes(const config::Configuration& model, const SeriesPlanRequest& request);

  const std::vector<std::string>& effects() const { return effects_; }
  // The strengths of the k-th effect. Nothing: a signal to stop came.
  std::optional<PlannedEffect> find(std::size_t k) const;

 private:
  std::optional<PlannedEffect> by_response(const std::string& effect) const;
  PlannedEffect brownian_levels() const;

  const config::Configuration& model_;
  const SeriesPlanRequest& request_;
  std::vector<std::string> effects_;
};

// The level of Brownian motion that is nearest to the viscosity of DOPC; the only one of others.
std::size_t typical_level(const PlannedEffect& planned, const config::Configuration& model,
                          const SeriesPlanRequest& request);

}  // namespace traceraft::explain
