#include "verification/selection/series/series_misfit.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::selection {
namespace {

constexpr int kTrendDegree = 3;

// (ln t)^power of one quantity, around the middle of all looks.
Vec power_of_time(const std::vector<likelihood::ObservedSeries>& blocks,
                  observations::Quantity quantity, int power) {
  double sum = 0, count = 0;
  for (const likelihood::ObservedSeries& block : blocks) {
    sum += block.ln_t.sum();
    count += static_cast<double>(block.ln_t.size());
  }
  return likelihood::per_look(blocks, [&](const likelihood::ObservedSeries& block, Eigen::Index i) {
    return block.quantity == quantity ? std::pow(block.ln_t[i] - sum / count, power) : 0.0;
  });
}

}  // namespace

double trend_left(const std::vector<likelihood::ObservedSeries>& blocks,
                  const likelihood::EnsembleModel& model, const likelihood::EnsembleFit& fit) {
  const likelihood::ObservationMetric metric = likelihood::metric_of(blocks, model, fit);
  std::vector<Vec> trends;
  for (const observations::Quantity quantity : observations::kQuantities)
    for (int power = 0; power <= kTrendDegree; ++power) {
      Vec trend = power_of_time(blocks, quantity, power);
      for (const Vec& before : trends) trend -= metric.product(before, trend) * before;
      const double norm = std::sqrt(metric.product(trend, trend));
      if (norm > 1e-6) trends.push_back(trend / norm);
    }
  const Vec r = likelihood::residual(blocks, model, fit);
  double squares = 0;
  for (const Vec& trend : trends) squares += std::pow(metric.product(trend, r), 2);
  return squares;
}

std::vector<SeriesOffset> offsets(const std::vector<likelihood::ObservedSeries>& blocks,
                                  const likelihood::EnsembleModel& model,
                                  const likelihood::EnsembleFit& fit) {
  const likelihood::ObservationMetric metric = likelihood::metric_of(blocks, model, fit);
  const Vec r = likelihood::residual(blocks, model, fit);
  std::vector<SeriesOffset> all;
  for (const observations::Quantity quantity : observations::kQuantities) {
    const Vec level = power_of_time(blocks, quantity, 0);
    Vec slope = power_of_time(blocks, quantity, 1);
    const double levels = metric.product(level, level);
    if (!(levels > 0)) continue;
    slope -= metric.product(level, slope) / levels * level;
    const double slopes = std::max(metric.product(slope, slope), 1e-12);
    const double by_level = metric.product(level, r), by_slope = metric.product(slope, r);
    all.push_back({quantity, by_level / levels, by_level / std::sqrt(levels), by_slope / slopes,
                   by_slope / std::sqrt(slopes)});
  }
  return all;
}

}  // namespace traceraft::selection
