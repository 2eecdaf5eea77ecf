// How probable series of vesicles are if simulated vesicles tell the truth: the likelihood of what
// was counted and measured at a few looks, with the unit of time, all scatter and the strength of
// an effect free.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "kernel/core/types.hpp"
#include "verification/series/run_curves.hpp"
#include "verification/vesicles/measurements.hpp"

namespace traceraft {

// Looks at one quantity of one vesicle.
struct SeriesBlock {
  Quantity quantity;
  Vec ln_t;      // of seconds
  Vec values;    // logarithms
  Vec variance;  // that is known: of rounding, and of what the data state
};
// Values that are not positive say nothing.
std::vector<SeriesBlock> blocks_of(const MeasuredVesicles& data);

// Vesicles scatter around the mean of the runs; looks at a vesicle scatter around what is its own.
struct SeriesScatter {
  std::array<double, 3> vesicle, look;  // standard deviations, per quantity
};

// The model with an effect of strength a has the logarithms mean + a (changed − mean).
struct SeriesModel {
  const RunCurves* base;
  const RunCurves* changed = nullptr;  // with the effect at strength 1; none: the base alone
  bool two_sided = true;
};

// Of an effect, over what has been simulated: a fit does not leave that either.
inline constexpr double kLargestAmplitude = 2;

struct SeriesFit {
  double ln_unit = 0;    // of R²/D in seconds
  double amplitude = 0;  // a
  double deviation = 0;  // of a; 0 if there is no effect
  SeriesScatter scatter;
  double deviance;  // −2 ln of the likelihood
};

// Seconds per unit of time: what is known of it before, with 95 % confidence within a factor. The
// fit does not leave that (or `reach`), nor what is at least needed for runs to last as long as the
// data.
struct UnitRange {
  double start, factor;
  double least = 0;
  double reach = 1;  // of the fit, beyond the factor if larger than 1: a power of it

  double deviation() const;  // of ln of the unit, before
  // Of ln of the unit, where a fit may end.
  double lowest() const;
  double highest() const;
};
SeriesFit fit_series(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
                     const UnitRange& unit);
// From the fit of a model that differs little.
SeriesFit fit_series(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
                     const UnitRange& unit, const SeriesFit& near);

// The inner product in which looks are independent and of variance 1, of vectors with an entry per
// look, block after block.
class SeriesMetric {
 public:
  SeriesMetric(const std::vector<SeriesBlock>& blocks, const RunCurves& base, double ln_unit,
               const SeriesScatter& scatter);
  // `only`: of one quantity alone.
  double product(const Vec& u, const Vec& v, std::optional<Quantity> only = {}) const;
  double log_determinant() const;

 private:
  struct Block {
    Quantity quantity;
    Eigen::Index first, count;
    double shared;  // variance of what is the vesicle's own
    Vec inverse;    // of the variances of the looks
  };
  std::vector<Block> blocks_;
};

// With an entry per look: measured minus model.
Vec residual(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
             const SeriesFit& fit);
// What is left of a fit that polynomials of ln t explain, a cubic for each quantity, in squares of
// standard deviations.
double trend_left(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
                  const SeriesFit& fit);

// How the logarithms of measurements of a quantity lie beside a fit: on average, and per e-fold of
// time; and in standard deviations.
struct SeriesOffset {
  Quantity quantity;
  double level, level_deviations, slope, slope_deviations;
};
// Of those that were measured.
std::vector<SeriesOffset> offsets(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
                                  const SeriesFit& fit);

// With an entry per look: changed − mean, or the derivative of the mean by ln of the unit of time.
Vec response(const std::vector<SeriesBlock>& blocks, const RunCurves& base,
             const RunCurves& changed, double ln_unit);
Vec unit_response(const std::vector<SeriesBlock>& blocks, const RunCurves& base, double ln_unit);

}  // namespace traceraft
