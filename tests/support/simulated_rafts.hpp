// A simulator that costs nothing: rafts whose number falls as a law says, and scatters as
// independent rafts do.
#pragma once

#include <cmath>
#include <vector>

#include "kernel/core/random.hpp"
#include "kernel/core/types.hpp"
#include "verification/calibration/calibration.hpp"
#include "verification/calibration/joint_fit.hpp"
#include "verification/calibration/local_regression.hpp"
#include "verification/observations/published.hpp"

namespace traceraft::simulated_rafts {

inline double normal(std::uint64_t seed, std::uint64_t index) {
  return std::sqrt(-2 * std::log(uniform_random(seed, 1, index))) *
         std::cos(2 * kPi * uniform_random(seed, 2, index));
}

// Rafts at the time t in units of R²/D: from N₀ on, N falls like (1 + ε² t)^(-2/3). If `start` the
// first number goes with 1/ε², so that ε is seen apart from D.
inline std::vector<observations::History> simulate(double epsilon, bool start, int count,
                                                   std::uint64_t first_seed) {
  std::vector<observations::History> runs;
  for (int k = 0; k < count; ++k) {
    const double own = normal(first_seed + k, 0);
    const double first = start ? 0.6 / (epsilon * epsilon) : 60;
    observations::History run;
    for (double t = 1; t <= 1e5; t *= 1.1) {
      const double mean = first * std::pow(1 + epsilon * epsilon * t, -2.0 / 3);
      const double n = std::max(1.0, mean * std::exp(own / std::sqrt(mean)));
      run.time.push_back(t);
      run.of(observations::Quantity::rafts).push_back(std::round(n));
      run.of(observations::Quantity::fraction).push_back(0.1);
      run.of(observations::Quantity::perimeter).push_back(4 * kPi * std::sqrt(0.1 * (n - 0.1)));
    }
    runs.push_back(run);
  }
  return runs;
}

inline constexpr double kSeconds = 0.025, kEpsilon = 0.1;  // the truth

inline observations::PublishedFacts design() {
  observations::PublishedFacts facts;
  facts.vesicles = 17;
  facts.measurements = 62;
  facts.fraction = 0.1;
  facts.fraction_sd = 0.011;
  facts.radius_min = facts.radius_max = 5;
  facts.perimeter.scatter = 0.15;
  facts.window = {1, 100};
  return facts;
}

inline observations::MeasuredVesicles measured(bool start, std::uint64_t seed) {
  std::vector<observations::History> vesicles = simulate(kEpsilon, start, 17, 1000 * seed);
  for (observations::History& vesicle : vesicles)
    for (double& t : vesicle.time) t *= kSeconds;
  return observations::draw_from_runs(design(), vesicles, 5, seed);
}

inline const std::vector<calibration::SoughtParameter> kSought = {{"epsilon", {1e-3, 10}}};

inline likelihood::UnitPrior around(double seconds) {
  return likelihood::UnitPrior::uniform(seconds, {seconds / 8, seconds * 8});
}

// Around the start, then around what is found, as the program does.
inline std::vector<calibration::CalibrationPoint> points_for(
    const observations::MeasuredVesicles& data, bool start, std::uint64_t seed,
    double epsilon_start) {
  std::vector<calibration::CalibrationPoint> points;
  std::vector<double> centre{std::log(epsilon_start)};
  for (const double step : {0.5, 0.25, 0.1}) {
    for (const auto& ln : calibration::design_around(centre, step))
      points.push_back({ln, simulate(std::exp(ln[0]), start, 40, 500000 + 1000 * seed)});
    centre = calibration::most_probable(data, kSought, points, around(1.5 * kSeconds));
  }
  return points;
}

inline calibration::Calibration calibrated(bool start, std::uint64_t seed, double epsilon_start) {
  const observations::MeasuredVesicles data = measured(start, seed);
  return calibration::calibrate(data, kSought, points_for(data, start, seed, epsilon_start),
                                around(1.5 * kSeconds));
}

}  // namespace traceraft::simulated_rafts
