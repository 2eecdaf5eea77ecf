#include "verification/selection/series/series_unit_range.hpp"

#include <algorithm>
#include <cmath>

#include "verification/statistics/sample.hpp"

namespace traceraft::selection {
namespace {

// From an end of what is allowed, in ln of the unit.
constexpr double kAtEnd = 0.1;

class UnitProfile {
 public:
  UnitProfile(const std::vector<likelihood::ObservedSeries>& blocks,
              const likelihood::UnitPrior& unit, double widening)
      : blocks_(blocks), unit_(unit), widening_(widening) {}

  // Along the amplitudes of an effect, each time with the best unit. Where the deviance is `excess`
  // above its minimum, √(1.96² − excess) standard deviations are left of 1.96.
  void add(const std::string& effect, const likelihood::EnsembleModel& model,
           const likelihood::EnsembleFit& base, double least_deviance, double noise) {
    const double most = least_deviance + std::pow(statistics::kNormal95, 2) * std::max(1.0, noise);
    const double step = model.has_several_levels() ? 0.5 : 0.25;
    widen_by("", base, most);
    for (const double direction : {step, -step}) {
      likelihood::EnsembleFit near = base;
      for (double a = direction; a <= model.largest_amplitude() && a >= model.least_amplitude();
           a += direction) {
        const likelihood::RunCurves curves = model.at(a);
        near = likelihood::fit_ensemble(blocks_, {&curves}, unit_, near);
        widen_by(effect, near, most);
      }
    }
  }

  UnitRange range() const {
    UnitRange result = range_;
    result.low_open = result.low < unit_.lowest() + kAtEnd;
    result.high_open = result.high > unit_.highest() - kAtEnd;
    return result;
  }

 private:
  void widen_by(const std::string& effect, const likelihood::EnsembleFit& fit, double most) {
    if (fit.deviance > most) return;
    const double width = widening_ * std::sqrt((most - fit.deviance) * fit.covariance(0, 0)),
                 low = std::max(fit.ln_unit - width, unit_.lowest()),
                 high = std::min(fit.ln_unit + width, unit_.highest());
    if (low < range_.low) {
      range_.low = low;
      range_.low_by = effect;
    }
    if (high > range_.high) {
      range_.high = high;
      range_.high_by = effect;
    }
  }

  const std::vector<likelihood::ObservedSeries>& blocks_;
  const likelihood::UnitPrior& unit_;
  const double widening_;
  UnitRange range_{HUGE_VAL, -HUGE_VAL, "", "", false, false};
};

}  // namespace

UnitRange unit_range(const std::vector<likelihood::ObservedSeries>& blocks,
                     const SeriesCurves& curves, const std::vector<SeriesCandidate>& candidates,
                     const std::vector<std::size_t>& numbers, const SeriesGains& gains,
                     const Vec& null_means, const likelihood::UnitPrior& unit, double widening) {
  UnitProfile profile(blocks, unit, widening);
  double least = gains.base.deviance;
  for (const std::size_t k : numbers) least = std::min(least, gains.fits[k].deviance);
  for (const std::size_t k : numbers)
    profile.add(candidates[k].effect, curves.with(k), gains.base, least,
                null_means[static_cast<Eigen::Index>(k)]);
  return profile.range();
}

}  // namespace traceraft::selection
