#include "verification/selection/series/series_explanation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/core/error.hpp"
#include "verification/selection/fit/score_test.hpp"
#include "verification/selection/search/bounds.hpp"
#include "verification/selection/series/series_need.hpp"
#include "verification/selection/series/series_responses.hpp"
#include "verification/statistics/bootstrap.hpp"

namespace traceraft::selection {
namespace {

// kAtEnd: the distance from an end of the range of ln of the unit within which a fit lies at that
// end, as a share of the range; kMostAtEnd: its largest value. kTold: the deviation of ln of the
// unit below which data tell the unit, over its deviation before.
constexpr double kAtEnd = 0.05, kMostAtEnd = 0.1, kTold = 0.7;
// Deviations from an end at which it does not matter.
constexpr double kFree = 2;

void refuse(const observations::MeasuredVesicles& data,
            const std::vector<observations::History>& base,
            const std::vector<SeriesCandidate>& candidates) {
  refuse_vesicles(data);
  if (candidates.empty()) throw InputError("series: no effect is left to search for");
  if (base.size() < 3) throw InputError("series need three runs of every model at least");
  for (const SeriesCandidate& candidate : candidates)
    for (const SeriesLevel& level : candidate.levels)
      if (level.runs.size() != base.size())
        throw InputError("the ensemble with " + candidate.effect + " has other runs than the base");
}

// The unit of time at which the last look lies at the end of the runs. With a larger D the last
// looks would lie beyond it.
double shortest_unit(const observations::MeasuredVesicles& data,
                     const std::vector<observations::History>& base,
                     const std::vector<SeriesCandidate>& candidates) {
  double end = std::numeric_limits<double>::infinity(), last = 0;
  const auto shorten = [&](const std::vector<observations::History>& runs) {
    for (const observations::History& run : runs) end = std::min(end, run.time.back());
  };
  shorten(base);
  for (const SeriesCandidate& candidate : candidates)
    for (const SeriesLevel& level : candidate.levels) shorten(level.runs);
  for (const observations::Measurement& m : data.measurements) last = std::max(last, m.time);
  return last / end;
}

// The level of each candidate that is nearest to its fit; the typical one if that has none of it.
std::vector<std::size_t> levels_shown(const SeriesGains& gains,
                                      const std::vector<SeriesCandidate>& candidates) {
  std::vector<std::size_t> levels;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const auto last = static_cast<long>(candidates[k].levels.size());
    const long nearest = std::min(std::lround(gains.fits[k].amplitude), last);
    levels.push_back(nearest < 1 || last == 1 ? candidates[k].typical
                                              : static_cast<std::size_t>(nearest - 1));
  }
  return levels;
}

// Where there are several levels the logarithm of the strength is what is known, once it is not
// near zero.
statistics::Interval strength_bounds(const SeriesCandidate& candidate,
                                     const likelihood::EnsembleFit& fit, double width) {
  const double value = candidate.strength_at(fit.amplitude);
  if (candidate.has_one_level()) return {candidate.two_sided ? value - width : 0.0, value + width};
  if (fit.amplitude <= 1) return {0, value + width};
  return {value * std::exp(-width / value), value * std::exp(width / value)};
}

struct Squares {
  double sum = 0, count = 0;

  void add(double x) { sum += x * x, ++count; }
  double mean() const { return count > 0 ? sum / count : 0; }
};

class SeriesSearch {
 public:
  SeriesSearch(const observations::MeasuredVesicles& data,
               const std::vector<observations::History>& base,
               const std::vector<SeriesCandidate>& candidates, const SeriesRequest& request)
      : data_(data),
        candidates_(candidates),
        request_(request),
        blocks_(likelihood::observed_series(data)),
        curves_(SeriesSamples(base, candidates), candidates),
        gains_(gains_of(blocks_, curves_, candidates.size(), request.unit,
                        likelihood::fit_ensemble(blocks_, {&curves_.base}, request.unit))),
        levels_(levels_shown(gains_, candidates)),
        responses_(blocks_, curves_, levels_, gains_.base, request.unit),
        classes_(classes_of(responses_, candidates.size())),
        null_(null_of(data, base, candidates, gains_.base, request.unit, request.replicates)),
        surprise_(surprise_of(gains_.values, null_)),
        noise_(noise_of_more(data, base, candidates, gains_.base, request.unit, null_)) {}

  SeriesExplanation run() {
    result_.vesicles = static_cast<int>(data_.vesicles().size());
    result_.looks = static_cast<int>(data_.measurements.size());
    result_.base = gains_.base;
    result_.unit_deviation = unit_deviation();
    const double from_end = std::min(gains_.base.ln_unit - request_.unit.lowest(),
                                     request_.unit.highest() - gains_.base.ln_unit);
    const double range = request_.unit.highest() - request_.unit.lowest();
    result_.unit_at_end = from_end < std::min(kMostAtEnd, kAtEnd * range);
    result_.unit_told = result_.unit_deviation < kTold * request_.unit.deviation;
    result_.offsets = gains_.offsets;
    in_deviations_of_noise(result_.offsets);
    result_.p = 1;
    for (std::size_t k = 0; k < candidates_.size(); ++k) result_.scores.push_back(score_of(k));
    for (const auto& members : classes_) result_.classes.push_back(names_of(members));
    judge();
    result_.unit_range = range_of_unit();
    std::sort(result_.scores.begin(), result_.scores.end(),
              [this](const SeriesScore& a, const SeriesScore& b) { return more_telling(a, b); });
    return std::move(result_);
  }

 private:
  void in_deviations_of_noise(std::vector<SeriesOffset>& offsets) const {
    for (SeriesOffset& offset : offsets) {
      const auto q = static_cast<std::size_t>(offset.quantity);
      offset.level_deviations /= null_.levels[q];
      offset.slope_deviations /= null_.slopes[q];
    }
  }

  // From drawn data, whose fits end where that of the measurements does: near an end the larger of
  // both sides. 1.96 times it is the half of a 95 % interval, as the runs are few, which is no
  // wider than what was known of D before.
  double unit_deviation() const {
    const double ln_unit = gains_.base.ln_unit;
    const double below = ln_unit - request_.unit.lowest();
    const double above = request_.unit.highest() - ln_unit;
    const double side = above > below ? 1 : -1;
    Squares away, back;
    for (const double drawn : null_.ln_unit)
      (side * (drawn - ln_unit) > 0 ? away : back).add(drawn - ln_unit);
    const double known = request_.unit.deviation;
    if (away.count == 0) return known;  // all of them lie towards the end
    const double both = std::sqrt((away.sum + back.sum) / (away.count + back.count));
    const double own = std::min(above, below) > kFree * both
                           ? both
                           : std::sqrt(std::max(away.mean(), back.mean()));
    const int runs = static_cast<int>(candidates_.front().levels.front().runs.size());
    return std::min(statistics::student_factor(runs) * own, known);
  }

  // Errors of the unit from drawn data are larger than those of the fit.
  UnitRange range_of_unit() const {
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k < candidates_.size(); ++k)
      if (!is_named(result_.finding) || is_named_member(candidates_[k].effect))
        numbers.push_back(k);
    const double fitted = std::sqrt(gains_.base.covariance(0, 0));
    return unit_range(blocks_, curves_, candidates_, numbers, gains_, null_.mean, request_.unit,
                      std::max(1.0, result_.unit_deviation / fitted));
  }
  bool is_named_member(const std::string& effect) const {
    return std::any_of(result_.named.begin(), result_.named.end(), [&](const auto& members) {
      return std::count(members.begin(), members.end(), effect) > 0;
    });
  }

  SeriesScore score_of(std::size_t k) {
    const likelihood::EnsembleModel model = curves_.with(k);
    const likelihood::EnsembleFit& fit = gains_.fits[k];
    const SeriesCandidate& candidate = candidates_[k];
    const double gain = gains_.values[static_cast<Eigen::Index>(k)];
    const double noise = null_.mean[static_cast<Eigen::Index>(k)];
    const double p =
        share_of_noise(surprise_.highest, surprise_.data[static_cast<Eigen::Index>(k)]);
    result_.p = std::min(result_.p, p);
    // Bounds know the error of the runs by what noise gains too much.
    const double deviation =
        candidate.deviation(likelihood::with_error_of_runs(blocks_, model, fit));
    const statistics::Interval bounds = strength_bounds(
        candidate, fit, bound_width(candidate.deviation(fit), 1, candidate.two_sided, noise));
    const double least = candidate.strength_at(model.least_amplitude()),
                 most = candidate.strength_at(model.largest_amplitude());
    return {candidate.effect,
            gain,
            noise,
            p,
            share_of_noise(null_.trend, trend_left(blocks_, model, fit)),
            fit.ln_unit,
            fit.amplitude,
            candidate.strength_at(fit.amplitude),
            deviation,
            bounds.low,
            bounds.high,
            bounds.low >= std::min(least, most) && bounds.high <= std::max(least, most),
            levels_[k],
            needed(responses_.of(k), k),
            responses_.telling(responses_.of(k))};
  }

  // Vesicles like these that show it beside what noise gains by effect k.
  double needed(const SeriesResponse& response, std::size_t k) const {
    return result_.vesicles * times_needed(responses_.products(response), noise_[k]);
  }

  std::vector<std::string> names_of(const std::vector<std::size_t>& members) const {
    std::vector<std::string> names;
    for (const std::size_t k : members) names.push_back(candidates_[k].effect);
    return names;
  }

  bool significant(double p) const { return p <= request_.false_alarms; }

  bool leaves_trend(const SeriesScore& score) const {
    return score.trend_p <= kTrendLevel * request_.false_alarms;
  }

  // One beside which a trend is left does not explain the data. Of two that noise hardly explains
  // the more probable one is the more telling. Their p says which those are, not which of them it
  // is.
  bool more_telling(const SeriesScore& a, const SeriesScore& b) const {
    const auto explains = [this](const SeriesScore& s) {
      return significant(s.p) && !leaves_trend(s);
    };
    if (explains(a) != explains(b)) return explains(a);
    if (significant(a.p) != significant(b.p)) return significant(a.p);
    return significant(a.p) ? a.gain > b.gain : a.p < b.p;
  }
  // Before scores are sorted.
  std::size_t best_of(const std::vector<std::size_t>& candidates) const {
    return *std::min_element(candidates.begin(), candidates.end(),
                             [this](std::size_t a, std::size_t b) {
                               return more_telling(result_.scores[a], result_.scores[b]);
                             });
  }

  void judge() {
    const bool lacking = significant(result_.p);
    const auto best = static_cast<std::size_t>(
        std::min_element(
            result_.scores.begin(), result_.scores.end(),
            [this](const SeriesScore& a, const SeriesScore& b) { return more_telling(a, b); }) -
        result_.scores.begin());
    result_.trend_p =
        lacking ? result_.scores[best].trend_p : share_of_noise(null_.trend, gains_.trend);
    result_.best_offsets = offsets(blocks_, curves_.with(best), gains_.fits[best]);
    in_deviations_of_noise(result_.best_offsets);
    if (result_.trend_p <= kTrendLevel * request_.false_alarms) {
      result_.finding = Finding::unnamed;
      if (lacking) result_.named = {{candidates_[best].effect}};
      return;
    }
    if (!lacking) {
      const bool blind =
          std::none_of(result_.scores.begin(), result_.scores.end(),
                       [&](const SeriesScore& s) { return s.vesicles <= result_.vesicles; });
      result_.finding = blind ? Finding::not_identifiable : Finding::none;
      return;
    }
    name_class_of(best);
    result_.finding = result_.named.size() > 1 || result_.named.front().size() > 1
                          ? Finding::ambiguous
                          : Finding::named;
  }

  // And classes that explain the data nearly as well.
  void name_class_of(std::size_t best) {
    const auto gain = [this](std::size_t k) { return gains_.values[static_cast<Eigen::Index>(k)]; };
    const double noise = std::max(1.0, null_.mean[static_cast<Eigen::Index>(best)]);
    for (const auto& members : classes_) {
      const std::size_t other = best_of(members);
      if (std::count(members.begin(), members.end(), best) > 0) {
        result_.named.insert(result_.named.begin(), names_of(members));
      } else if (gain(best) - gain(other) < kTelling * noise &&
                 !leaves_trend(result_.scores[other])) {
        result_.named.push_back(names_of(members));
        const double factor = candidates_[best].has_one_level() ? gains_.fits[best].amplitude : 1.0;
        const SeriesResponse difference = factor * responses_.beyond(best, other);
        result_.ties.push_back({candidates_[best].effect, candidates_[other].effect,
                                needed(difference, best), responses_.telling(difference)});
      }
    }
  }

  const observations::MeasuredVesicles& data_;
  const std::vector<SeriesCandidate>& candidates_;
  const SeriesRequest& request_;
  const std::vector<likelihood::ObservedSeries> blocks_;
  const SeriesCurves curves_;
  const SeriesGains gains_;
  const std::vector<std::size_t> levels_;  // per candidate, whose responses are meant
  const SeriesResponses responses_;
  const SeriesClasses classes_;
  const SeriesNull null_;
  const SeriesSurprise surprise_;
  const std::vector<SeriesNoise> noise_;  // per candidate
  SeriesExplanation result_;
};

}  // namespace

void refuse_vesicles(const observations::MeasuredVesicles& data) {
  if (data.vesicles().size() < 3)
    throw InputError("series need three vesicles at least, to know how they scatter");
}

SeriesExplanation explain_series(const observations::MeasuredVesicles& data,
                                 const std::vector<observations::History>& base,
                                 const std::vector<SeriesCandidate>& candidates,
                                 const SeriesRequest& request) {
  refuse(data, base, candidates);
  SeriesRequest covered = request;
  covered.unit.allowed.low =
      std::max(request.unit.allowed.low, shortest_unit(data, base, candidates));
  if (covered.unit.allowed.low > covered.unit.allowed.high)
    throw InputError("series: the runs end before the last measurement, whatever D is");
  return SeriesSearch(data, base, candidates, covered).run();
}

}  // namespace traceraft::selection
