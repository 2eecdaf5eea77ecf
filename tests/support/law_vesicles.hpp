// Vesicles whose curves are formulas, and what series say of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kernel/core/random.hpp"
#include "verification/selection/series/series_explanation.hpp"

namespace traceraft::law_vesicles {

// A vesicle at times of 1 to 1000 units: the perimeter falls like t^(−1/3) to a plateau, the
// fraction drifts, and there are more rafts of the same perimeter.
struct RaftLaw {
  double exponent = -1 / 3.0, plateau = 0, drift = 0, more_rafts = 0;
};
inline observations::History vesicle(const RaftLaw& law, std::uint64_t seed,
                                     double seconds_per_unit = 1) {
  observations::History history;
  const double own = 0.08 * normal_random(seed, 1, 0);
  for (int k = 0; k <= 60; ++k) {
    const double t = std::pow(10.0, k / 20.0);
    const double p = (30 * std::pow(t, law.exponent) + law.plateau) * std::exp(own);
    history.time.push_back(t * seconds_per_unit);
    history.of(observations::Quantity::perimeter).push_back(p);
    history.of(observations::Quantity::rafts)
        .push_back(std::max(1.0, std::round((1 + law.more_rafts) * p * p / 10)));
    history.of(observations::Quantity::fraction).push_back(0.1 * (1 + law.drift * std::log(t)));
  }
  return history;
}

inline std::vector<observations::History> ensemble(const RaftLaw& law) {
  std::vector<observations::History> runs;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) runs.push_back(vesicle(law, seed));
  return runs;
}

inline std::vector<selection::SeriesCandidate> candidates() {
  return {{"uptake", {{2, ensemble({-1 / 3.0, 0, 0.05})}}, true},
          {"cooling", {{1, ensemble({-1 / 3.0, 0, 0.06})}}, true},
          {"ohta-kawasaki", {{3, ensemble({-1 / 3.0, 2, 0})}}, false},
          {"line-tension", {{1, ensemble({-1 / 3.0, 0, 0, 0.3})}}, true}};
}

inline observations::MeasuredVesicles measured(const RaftLaw& law, int vesicles, double noise,
                                               double seconds_per_unit,
                                               std::uint64_t first_seed = 100) {
  observations::MeasuredVesicles data;
  for (int v = 0; v < vesicles; ++v) {
    const observations::History history =
        vesicle(law, first_seed + static_cast<std::uint64_t>(v), seconds_per_unit);
    for (int k = 0; k < 6; ++k) {
      observations::Measurement m;
      m.vesicle = std::to_string(v);
      m.time = seconds_per_unit * std::pow(10.0, 0.3 + 0.45 * k + 0.02 * (v % 20));
      m.radius = 5;
      for (const observations::Quantity quantity : observations::kQuantities) {
        const auto q = observations::index_of(quantity);
        const double scatter =
            noise * normal_random(7 + q, 1, static_cast<std::uint64_t>(10 * v + k));
        m.values[q] = history.at(quantity, m.time) * std::exp(scatter);
      }
      data.measurements.push_back(m);
    }
  }
  return data;
}

inline selection::SeriesExplanation explained(const observations::MeasuredVesicles& data) {
  selection::SeriesRequest request{likelihood::UnitPrior::within_factor(1, 8)};
  request.replicates = 99;
  return selection::explain_series(data, ensemble({}), candidates(), request);
}

// Where it does not matter what effects do.
inline selection::SeriesExplanation compared(const observations::MeasuredVesicles& data,
                                             const selection::SeriesRequest& request) {
  return selection::explain_series(data, ensemble({}), {candidates()[0]}, request);
}

inline void keep_only(observations::Quantity kept, observations::MeasuredVesicles& data) {
  for (observations::Measurement& m : data.measurements)
    for (const observations::Quantity quantity : observations::kQuantities)
      if (quantity != kept) m.values[observations::index_of(quantity)].reset();
}

}  // namespace traceraft::law_vesicles
