// Series as vectors with an entry per look, and how looks scatter and depend on each other.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "kernel/core/types.hpp"
#include "verification/series/run_curves.hpp"
#include "verification/vesicles/measurements.hpp"
#include "verification/vesicles/stated_errors.hpp"

namespace traceraft {

// Looks at one quantity of one vesicle.
struct SeriesBlock {
  Quantity quantity;
  Vec ln_t;    // of seconds
  Vec values;  // logarithms
  std::vector<StatedError> stated;
};
// Values that are not positive say nothing.
std::vector<SeriesBlock> blocks_of(const MeasuredVesicles& data);

// Vesicles scatter around the mean of the runs; looks at a vesicle scatter around what is its own.
struct SeriesScatter {
  std::array<double, 3> vesicle, look;  // standard deviations, per quantity
};

// value(block, i) of every look, block after block.
template <class Value>
Vec per_look(const std::vector<SeriesBlock>& blocks, const Value& value) {
  Eigen::Index count = 0;
  for (const SeriesBlock& block : blocks) count += block.values.size();
  Vec result(count);
  Eigen::Index next = 0;
  for (const SeriesBlock& block : blocks)
    for (Eigen::Index i = 0; i < block.values.size(); ++i) result[next++] = value(block, i);
  return result;
}

// The same of another such vector's entries: value(block, i, entry).
template <class Value>
Vec per_look(const std::vector<SeriesBlock>& blocks, const Vec& entries, const Value& value) {
  Eigen::Index next = 0;
  return per_look(blocks, [&](const SeriesBlock& block, Eigen::Index i) {
    return value(block, i, entries[next++]);
  });
}

// With an entry per look: the variance without the scatter that is fitted, that of what the data
// state and that between runs, of which each vesicle is one. (What looks at one vesicle share of
// the latter is left to the fitted scatter.)
// `expected`: logarithms.
Vec known_variance(const std::vector<SeriesBlock>& blocks, const RunCurves& base, double ln_unit,
                   const Vec& expected);

// The inner product in which looks are independent and of variance 1, of vectors with an entry per
// look.
class SeriesMetric {
 public:
  // `only`: products and determinant are those of the looks at one quantity alone.
  SeriesMetric(const std::vector<SeriesBlock>& blocks, const Vec& known,
               const SeriesScatter& scatter, std::optional<Quantity> only = {});
  double product(const Vec& u, const Vec& v, std::optional<Quantity> only = {}) const;
  double log_determinant() const;  // of the covariance

 private:
  struct Block {
    Quantity quantity;
    Eigen::Index first, count;
    double shared;  // variance of what is the vesicle's own
    double sum;     // of inverse_
  };
  std::vector<Block> blocks_;
  Vec inverse_;  // of the variances of looks by themselves
};

}  // namespace traceraft
