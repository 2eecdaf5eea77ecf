#include "verification/likelihood/observations.hpp"

#include <cmath>

#include "verification/statistics/bootstrap.hpp"
#include "verification/statistics/log_of_product.hpp"

namespace traceraft::likelihood {

std::vector<ObservedSeries> observed_series(const observations::MeasuredVesicles& data,
                                            const std::vector<int>& vesicles,
                                            const std::vector<observations::Quantity>& quantities) {
  std::vector<ObservedSeries> blocks;
  const observations::StatedErrors errors(data);
  const auto all = data.vesicles();
  for (const int vesicle : vesicles)
    for (const observations::Quantity quantity : quantities) {
      const auto [first, last] = all[static_cast<std::size_t>(vesicle)];
      std::vector<double> t, y;
      std::vector<observations::StatedError> stated;
      for (std::size_t i = first; i < last; ++i) {
        const observations::Measurement& m = data.measurements[i];
        const double value = m.of(quantity).value_or(0);
        if (!(value > 0) || !(m.time > 0)) continue;
        t.push_back(std::log(m.time));
        y.push_back(observations::logarithm_of(quantity, value));
        stated.push_back(errors.of(m, quantity));
      }
      const auto vec = [](const std::vector<double>& v) {
        return Vec(Eigen::Map<const Vec>(v.data(), static_cast<Eigen::Index>(v.size())));
      };
      if (!t.empty()) blocks.push_back({quantity, vec(t), vec(y), std::move(stated)});
    }
  return blocks;
}

std::vector<ObservedSeries> observed_series(const observations::MeasuredVesicles& data) {
  return observed_series(data, statistics::each_once(data.vesicles().size()));
}

BlockCovariances known_covariance(const std::vector<ObservedSeries>& blocks, const RunCurves& base,
                                  double ln_unit, const Vec& expected) {
  BlockCovariances result;
  Eigen::Index next = 0;
  for (const ObservedSeries& block : blocks) {
    const Eigen::Index count = block.values.size();
    const Vec ln_t = block.ln_t.array() - ln_unit;
    Eigen::MatrixXd covariance = base.covariance(block.quantity, ln_t);
    for (Eigen::Index i = 0; i < count; ++i)
      covariance(i, i) += block.stated[static_cast<std::size_t>(i)].of_logarithm(expected[next++]);
    result.push_back(std::move(covariance));
  }
  return result;
}

ObservationMetric::ObservationMetric(const std::vector<ObservedSeries>& blocks,
                                     const BlockCovariances& known,
                                     const ObservationScatter& scatter,
                                     std::optional<observations::Quantity> only) {
  Eigen::Index first = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const observations::Quantity quantity = blocks[b].quantity;
    const Eigen::Index count = blocks[b].values.size();
    if (!only || quantity == *only) {
      const auto q = observations::index_of(quantity);
      Eigen::MatrixXd covariance = known[b].array() + scatter.vesicle[q] * scatter.vesicle[q];
      covariance.diagonal().array() += scatter.look[q] * scatter.look[q];
      blocks_.push_back({quantity, first, count, covariance.llt()});
    }
    first += count;
  }
}

double ObservationMetric::product(const Vec& u, const Vec& v,
                                  std::optional<observations::Quantity> only) const {
  double sum = 0;
  for (const Block& block : blocks_) {
    if (only && block.quantity != *only) continue;
    const auto L = block.factor.matrixL();
    const Vec a = L.solve(u.segment(block.first, block.count));
    const Vec b = L.solve(v.segment(block.first, block.count));
    sum += a.dot(b);
  }
  return sum;
}

Vec ObservationMetric::solved(const Vec& v) const {
  Vec result = Vec::Zero(v.size());
  for (const Block& block : blocks_)
    result.segment(block.first, block.count) =
        block.factor.solve(v.segment(block.first, block.count));
  return result;
}

double ObservationMetric::log_determinant() const {
  statistics::LogOfProduct diagonal;
  for (const Block& block : blocks_) {
    const auto& L = block.factor.matrixLLT();
    for (Eigen::Index i = 0; i < block.count; ++i) diagonal.multiply(L(i, i));
  }
  return 2 * diagonal.value();
}

}  // namespace traceraft::likelihood
