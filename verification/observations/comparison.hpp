// Simulated vesicles held against measured ones.
#pragma once

#include <vector>

#include "verification/observations/history.hpp"
#include "verification/observations/measurements.hpp"

namespace traceraft::observations {

// How well the runs of an ensemble foretell one quantity.
struct Agreement {
  Quantity quantity;
  int measurements = 0;   // within the time that the runs cover
  int beyond = 0;         // outside that time: not compared
  int without_rafts = 0;  // looks that saw none, whose logarithm is nothing: not compared
  int within = 0;         // between the smallest and the largest of the runs
  double bias = 0;        // mean of (measured − mean of the runs) / deviation
  double misfit = 0;      // root of the mean square of the same
  double scatter = 0;     // root mean square of the deviation, relative to what is measured
  // `trend`: of the deviations that bias is the mean of, per e-fold of time. `trend_error`: its
  // standard error, of the vesicles, looks at one of which are alike, and of the runs. Both are 0
  // if there are too few vesicles or runs.
  double trend = 0, trend_error = 0;

  double trend_deviations() const;  // the trend in standard errors; 0 if it is roundoff
  bool has_trend() const;           // by more than 3.5 standard errors
};

// deviation²: the variance between n runs, times 1 + 1/n as their mean scatters, too, and sigma² of
// the measurement, as that of what is expected (stated_errors.hpp); logarithms of perimeters and
// counts, whose scatter is relative. Throws InputError if there are fewer than two runs.
std::vector<Agreement> compare_with_runs(const MeasuredVesicles& data,
                                         const std::vector<History>& runs);

// The agreement of vesicles of the same kind as n runs, without errors of measuring.
struct SameKind {
  // `within`: the share that lies within the range of the runs. `misfit`: larger than 1, as n runs
  // know their variance badly (Student's distribution; infinite for three).
  double within, misfit;
};
SameKind same_kind(std::size_t runs);

// Does next to nothing lie within the range of so many runs, or near it? Then these tell of
// something else.
bool lies_beside(const Agreement& agreement, std::size_t runs);

// The share of looks, over all runs that cover their time, at which the simulated vesicle has no
// raft; 0 if there are no such looks.
double share_without_rafts(const MeasuredVesicles& data, const std::vector<History>& runs);

}  // namespace traceraft::observations
