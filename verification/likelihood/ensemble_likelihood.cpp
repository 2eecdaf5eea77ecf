#include "verification/likelihood/ensemble_likelihood.hpp"

#include <algorithm>
#include <cmath>

#include "verification/measure/log_of_product.hpp"

namespace traceraft {

// Scratch of one evaluation, and what it sums up.
struct EnsembleLikelihood::Sums {
  std::vector<double> factor, whitened, deviation;
  double squares = 0;
  LogOfProduct diagonal;
};

EnsembleLikelihood::EnsembleLikelihood(const std::vector<ObservedSeries>& blocks,
                                       const EnsembleModel& model, const UnitPrior& unit)
    : model_(model), unit_(unit) {
  for (const ObservedSeries& series : blocks) {
    Block block{&series, {}};
    for (Eigen::Index i = 0; i < series.ln_t.size(); ++i)
      for (Eigen::Index j = 0; j <= i; ++j)
        block.correlation.push_back(
            model.base->correlation(series.quantity, series.ln_t[i] - series.ln_t[j]));
    most_looks_ = std::max(most_looks_, static_cast<std::size_t>(series.ln_t.size()));
    blocks_.push_back(std::move(block));
  }
}

double EnsembleLikelihood::deviance(const EnsembleFit& at) const {
  Sums sums;
  sums.factor.resize(most_looks_ * (most_looks_ + 1) / 2);
  sums.whitened.resize(most_looks_);
  sums.deviation.resize(most_looks_);
  for (const Block& block : blocks_) add(block, at, sums);
  return sums.squares + 2 * sums.diagonal.value() + unit_.deviance(at.ln_unit);
}

// A Cholesky factorisation row by row, each row of which whitens one more residual.
void EnsembleLikelihood::add(const Block& block, const EnsembleFit& at, Sums& sums) const {
  const ObservedSeries& series = *block.series;
  const auto q = static_cast<std::size_t>(series.quantity);
  const double shared = at.scatter.vesicle[q] * at.scatter.vesicle[q];
  const double look = at.scatter.look[q] * at.scatter.look[q];
  const auto count = static_cast<std::size_t>(series.values.size());
  double* row = sums.factor.data();
  const double* correlation = block.correlation.data();
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double t = series.ln_t[k] - at.ln_unit;
    const double mean = model_.mean(series.quantity, t, at.amplitude);
    sums.deviation[i] = std::sqrt(model_.base->variance(series.quantity, t));
    double residual = series.values[k] - mean - series.stated[i].bias(mean);
    const double* other = sums.factor.data();  // row j
    for (std::size_t j = 0; j <= i; ++j) {
      double value = sums.deviation[i] * sums.deviation[j] * correlation[j] + shared;
      if (j == i) value += look + series.stated[i].of_logarithm(mean);
      for (std::size_t m = 0; m < j; ++m) value -= row[m] * other[m];
      if (j < i) {
        row[j] = value / other[j];
        residual -= row[j] * sums.whitened[j];
      } else {
        row[j] = std::sqrt(value);
      }
      other += j + 1;
    }
    sums.whitened[i] = residual / row[i];
    sums.squares += sums.whitened[i] * sums.whitened[i];
    sums.diagonal.multiply(row[i]);
    row += i + 1;
    correlation += i + 1;
  }
}

}  // namespace traceraft
