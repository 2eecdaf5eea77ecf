#include "verification/series/series_metric.hpp"

#include <cmath>

#include "verification/measure/log_of_product.hpp"

namespace traceraft {

std::vector<SeriesBlock> blocks_of(const MeasuredVesicles& data) {
  std::vector<SeriesBlock> blocks;
  const StatedErrors errors(data);
  for (const auto& [first, last] : data.vesicles())
    for (const Quantity quantity : kQuantities) {
      std::vector<double> t, y;
      std::vector<StatedError> stated;
      for (std::size_t i = first; i < last; ++i) {
        const Measurement& m = data.measurements[i];
        const double value = m.of(quantity).value_or(0);
        if (!(value > 0) || !(m.time > 0)) continue;
        t.push_back(std::log(m.time));
        y.push_back(logarithm_of(quantity, value));
        stated.push_back(errors.of(m, quantity));
      }
      const auto vec = [](const std::vector<double>& v) {
        return Vec(Eigen::Map<const Vec>(v.data(), static_cast<Eigen::Index>(v.size())));
      };
      if (!t.empty()) blocks.push_back({quantity, vec(t), vec(y), std::move(stated)});
    }
  return blocks;
}

Vec known_variance(const std::vector<SeriesBlock>& blocks, const RunCurves& base, double ln_unit,
                   const Vec& expected) {
  return per_look(blocks, expected, [&](const SeriesBlock& block, Eigen::Index i, double mean) {
    return block.stated[static_cast<std::size_t>(i)].of_logarithm(mean) +
           base.variance(block.quantity, block.ln_t[i] - ln_unit);
  });
}

SeriesMetric::SeriesMetric(const std::vector<SeriesBlock>& blocks, const Vec& known,
                           const SeriesScatter& scatter, std::optional<Quantity> only)
    : inverse_(known.size()) {
  Eigen::Index first = 0;
  for (const SeriesBlock& block : blocks) {
    const Eigen::Index count = block.values.size();
    if (!only || block.quantity == *only) {
      const auto q = static_cast<std::size_t>(block.quantity);
      auto inverse = inverse_.segment(first, count).array();
      inverse = 1 / (known.segment(first, count).array() + scatter.look[q] * scatter.look[q]);
      blocks_.push_back(
          {block.quantity, first, count, scatter.vesicle[q] * scatter.vesicle[q], inverse.sum()});
    }
    first += count;
  }
}

// (W − s/(1 + s Σ w) w wᵀ) of each block, by Sherman and Morrison.
double SeriesMetric::product(const Vec& u, const Vec& v, std::optional<Quantity> only) const {
  double sum = 0;
  for (const Block& block : blocks_) {
    if (only && block.quantity != *only) continue;
    const auto inverse = inverse_.segment(block.first, block.count);
    const auto a = u.segment(block.first, block.count), b = v.segment(block.first, block.count);
    const double own = block.shared / (1 + block.shared * block.sum);
    sum += (a.array() * b.array() * inverse.array()).sum() - own * a.dot(inverse) * b.dot(inverse);
  }
  return sum;
}

double SeriesMetric::log_determinant() const {
  LogOfProduct shared, inverse;
  for (const Block& block : blocks_) {
    shared.multiply(1 + block.shared * block.sum);
    for (Eigen::Index i = 0; i < block.count; ++i) inverse.multiply(inverse_[block.first + i]);
  }
  return shared.value() - inverse.value();
}

}  // namespace traceraft
