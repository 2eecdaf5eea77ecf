// Observations of vesicles as vectors with an entry per look, and how these scatter and depend on
// each other.
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <optional>
#include <vector>

#include "kernel/core/types.hpp"
#include "verification/likelihood/run_curves.hpp"
#include "verification/observations/measurements.hpp"
#include "verification/observations/stated_errors.hpp"

namespace traceraft::likelihood {

// Looks at one quantity of one vesicle.
struct ObservedSeries {
  observations::Quantity quantity;
  Vec ln_t;    // of seconds
  Vec values;  // logarithms
  std::vector<observations::StatedError> stated;
};
// Looks at time zero and values that are not positive say nothing, and are left out. `vesicles`:
// indices, with repetition; `quantities`: those that count.
std::vector<ObservedSeries> observed_series(
    const observations::MeasuredVesicles& data, const std::vector<int>& vesicles,
    const std::vector<observations::Quantity>& quantities = {observations::kQuantities.begin(),
                                                             observations::kQuantities.end()});
// All vesicles, once each.
std::vector<ObservedSeries> observed_series(const observations::MeasuredVesicles& data);

// Vesicles scatter around the mean of the runs; looks at a vesicle scatter around what is its own.
struct ObservationScatter {
  std::array<double, 3> vesicle{}, look{};  // standard deviations, per quantity
};

// value(block, i) of every look, block after block.
template <class Value>
Vec per_look(const std::vector<ObservedSeries>& blocks, const Value& value) {
  Eigen::Index count = 0;
  for (const ObservedSeries& block : blocks) count += block.values.size();
  Vec result(count);
  Eigen::Index next = 0;
  for (const ObservedSeries& block : blocks)
    for (Eigen::Index i = 0; i < block.values.size(); ++i) result[next++] = value(block, i);
  return result;
}

// The same of another such vector's entries: value(block, i, entry).
template <class Value>
Vec per_look(const std::vector<ObservedSeries>& blocks, const Vec& entries, const Value& value) {
  Eigen::Index next = 0;
  return per_look(blocks, [&](const ObservedSeries& block, Eigen::Index i) {
    return value(block, i, entries[next++]);
  });
}

// A covariance of looks per block, without the scatter that is fitted: what the data state, by
// itself for each look, and what runs scatter by, of which each vesicle is one. `expected`:
// logarithms.
using BlockCovariances = std::vector<Eigen::MatrixXd>;
BlockCovariances known_covariance(const std::vector<ObservedSeries>& blocks, const RunCurves& base,
                                  double ln_unit, const Vec& expected);

// The inner product in which looks are independent and of variance 1, of vectors with an entry per
// look.
class ObservationMetric {
 public:
  // `only`: products and determinant are those of the looks at one quantity alone.
  ObservationMetric(const std::vector<ObservedSeries>& blocks, const BlockCovariances& known,
                    const ObservationScatter& scatter,
                    std::optional<observations::Quantity> only = {});
  double product(const Vec& u, const Vec& v, std::optional<observations::Quantity> only = {}) const;
  Vec solved(const Vec& v) const;  // the inverse of the covariance times v
  double log_determinant() const;  // of the covariance

 private:
  struct Block {
    observations::Quantity quantity;
    Eigen::Index first, count;
    Eigen::LLT<Eigen::MatrixXd> factor;
  };
  std::vector<Block> blocks_;
};

}  // namespace traceraft::likelihood
