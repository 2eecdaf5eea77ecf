#include "verification/series/series_explanation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/core/error.hpp"
#include "kernel/core/random.hpp"
#include "verification/explain/bounds.hpp"
#include "verification/explain/score_test.hpp"
#include "verification/measure/fit.hpp"

namespace traceraft {
namespace {

// Responses that correlate more are one class.
constexpr double kAlike = 0.8;
// A trend that no effect explains has to be that much less probable.
constexpr double kTrendLevel = 0.4;
// Streams of random numbers.
enum SeriesStream : std::uint64_t { kRunOf = 1, kVesicle = 2, kLook = 3, kSample = 4, kStated = 5 };

// The same looks at vesicles of the base model, one run each.
MeasuredVesicles draw_base(const MeasuredVesicles& data, const std::vector<History>& runs,
                           const SeriesFit& fit, std::uint64_t replicate) {
  MeasuredVesicles drawn_data = data;
  std::uint64_t vesicle = 0, look = 0;
  for (const auto& [first, last] : data.vesicles()) {
    const History& run = runs[static_cast<std::size_t>(
        random_index(static_cast<int>(runs.size()), replicate, kRunOf, vesicle))];
    for (std::size_t i = first; i < last; ++i)
      for (const Quantity quantity : kQuantities) {
        const auto q = static_cast<std::size_t>(quantity);
        ++look;
        if (!data.measurements[i].of(quantity)) continue;
        const double t = data.measurements[i].time / std::exp(fit.ln_unit);
        const double stated =
            data.measurements[i].sigma_of(quantity) / *data.measurements[i].of(quantity);
        const double own =
            stated * normal_random(replicate, kStated, look) +
            fit.scatter.vesicle[q] * normal_random(replicate, kVesicle, 3 * vesicle + q) +
            fit.scatter.look[q] * normal_random(replicate, kLook, look);
        const double value = std::exp(logarithm_of(quantity, run.at(quantity, t)) + own);
        drawn_data.measurements[i].values[q] =
            quantity == Quantity::rafts ? std::max(1.0, std::round(value)) : value;
      }
    ++vesicle;
  }
  return drawn_data;
}

struct Ensembles {
  RunCurves base;
  std::vector<RunCurves> changed;

  Ensembles(const std::vector<History>& runs, const std::vector<SeriesCandidate>& candidates,
            const std::vector<int>& sample)
      : base(runs, sample) {
    for (const SeriesCandidate& candidate : candidates)
      changed.emplace_back(candidate.runs, sample);
  }
};

struct Gains {
  SeriesFit base;
  std::vector<SeriesFit> fits;
  Vec values;
  double trend;  // left of the base
};

Gains gains_of(const MeasuredVesicles& data, const Ensembles& ensembles,
               const std::vector<SeriesCandidate>& candidates, const SeriesRequest& request) {
  const std::vector<SeriesBlock> blocks = blocks_of(data);
  Gains gains;
  gains.base = fit_series(blocks, {&ensembles.base}, request.unit);
  gains.trend = trend_left(blocks, {&ensembles.base}, gains.base);
  gains.values.resize(static_cast<Eigen::Index>(candidates.size()));
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    gains.fits.push_back(
        fit_series(blocks, {&ensembles.base, &ensembles.changed[k], candidates[k].two_sided},
                   request.unit, gains.base));
    gains.values[static_cast<Eigen::Index>(k)] =
        std::max(0.0, gains.base.deviance - gains.fits[k].deviance);
  }
  return gains;
}

// Responses of the looks to effects, as far as the unit of time does not make them.
class Responses {
 public:
  Responses(const std::vector<SeriesBlock>& blocks, const Ensembles& ensembles,
            const SeriesFit& fit)
      : metric_(blocks, ensembles.base, fit.ln_unit, fit.scatter) {
    const Vec unit = unit_response(blocks, ensembles.base, fit.ln_unit);
    const double uu = metric_.product(unit, unit) + 1e-12;
    for (const RunCurves& changed : ensembles.changed) {
      Vec e = response(blocks, ensembles.base, changed, fit.ln_unit);
      e -= metric_.product(unit, e) / uu * unit;
      own_.push_back(std::move(e));
    }
  }
  double squares(std::size_t k) const { return metric_.product(own_[k], own_[k]); }
  double correlation(std::size_t j, std::size_t k) const {
    const double norm = std::sqrt(squares(j) * squares(k));
    return norm > 0 ? metric_.product(own_[j], own_[k]) / norm : 0;
  }
  Quantity telling(const Vec& e) const {
    return *std::max_element(kQuantities.begin(), kQuantities.end(), [&](Quantity a, Quantity b) {
      return metric_.product(e, e, a) < metric_.product(e, e, b);
    });
  }
  const Vec& of(std::size_t k) const { return own_[k]; }
  // What effect k does of which no amount of effect j is capable.
  Vec beyond(std::size_t k, std::size_t j) const {
    const double jj = squares(j);
    return jj > 0 ? Vec(own_[k] - metric_.product(own_[j], own_[k]) / jj * own_[j]) : own_[k];
  }
  double squares(const Vec& e) const { return metric_.product(e, e); }

 private:
  SeriesMetric metric_;
  std::vector<Vec> own_;
};

using Classes = std::vector<std::vector<std::size_t>>;

// Every two members of a class are alike.
Classes classes_of(const Responses& responses, std::size_t count) {
  Classes classes;
  for (std::size_t k = 0; k < count; ++k) {
    const auto like_all = [&](const std::vector<std::size_t>& members) {
      return std::all_of(members.begin(), members.end(), [&](std::size_t j) {
        return std::fabs(responses.correlation(j, k)) > kAlike;
      });
    };
    const auto own = std::find_if(classes.begin(), classes.end(), like_all);
    if (own == classes.end())
      classes.push_back({k});
    else
      own->push_back(k);
  }
  return classes;
}

void refuse(const MeasuredVesicles& data, const std::vector<History>& base,
            const std::vector<SeriesCandidate>& candidates) {
  refuse_vesicles(data);
  if (candidates.empty()) throw InputError("series: no effect is left to look for");
  if (base.size() < 3) throw InputError("series need three runs of every model at least");
  for (const SeriesCandidate& candidate : candidates)
    if (candidate.runs.size() != base.size())
      throw InputError("the ensemble with " + candidate.effect + " has other runs than the base");
}

// With a larger D the last looks would lie beyond the runs.
double shortest_unit(const MeasuredVesicles& data, const std::vector<History>& base,
                     const std::vector<SeriesCandidate>& candidates) {
  double end = std::numeric_limits<double>::infinity(), last = 0;
  const auto shorten = [&](const std::vector<History>& runs) {
    for (const History& run : runs) end = std::min(end, run.time.back());
  };
  shorten(base);
  for (const SeriesCandidate& candidate : candidates) shorten(candidate.runs);
  for (const Measurement& m : data.measurements) last = std::max(last, m.time);
  return last / end;
}

class SeriesSearch {
 public:
  SeriesSearch(const MeasuredVesicles& data, const std::vector<History>& base,
               const std::vector<SeriesCandidate>& candidates, const SeriesRequest& request)
      : data_(data),
        base_(base),
        candidates_(candidates),
        request_(request),
        ensembles_(base, candidates, each_once(base.size())),
        gains_(gains_of(data, ensembles_, candidates, request)),
        responses_(blocks_of(data), ensembles_, gains_.base),
        classes_(classes_of(responses_, candidates.size())) {}

  SeriesExplanation run() {
    draw_null();
    result_.vesicles = static_cast<int>(data_.vesicles().size());
    result_.looks = static_cast<int>(data_.measurements.size());
    result_.base = gains_.base;
    result_.p = 1;
    for (std::size_t k = 0; k < candidates_.size(); ++k) result_.scores.push_back(score_of(k));
    for (const auto& members : classes_) result_.classes.push_back(names_of(members));
    judge();
    std::sort(result_.scores.begin(), result_.scores.end(),
              [](const SeriesScore& a, const SeriesScore& b) {
                return a.gain / a.null_mean > b.gain / b.null_mean;
              });
    return std::move(result_);
  }

 private:
  // Data of the base model, fitted with curves of resampled runs, which hold a third of the runs
  // that data come from not at all and others more than once.
  void draw_null() {
    const auto count = static_cast<Eigen::Index>(candidates_.size());
    Eigen::MatrixXd null(request_.replicates, count);
    null_trend_.resize(request_.replicates);
    for (int r = 0; r < request_.replicates; ++r) {
      const auto replicate = static_cast<std::uint64_t>(r + 1);
      const std::vector<int> sample = resample(static_cast<int>(base_.size()), replicate, kSample);
      const Gains gains = gains_of(draw_base(data_, base_, gains_.base, replicate),
                                   {base_, candidates_, sample}, candidates_, request_);
      null.row(r) = gains.values.transpose();
      null_trend_[r] = gains.trend;
    }
    null_mean_ = null.colwise().mean().transpose().cwiseMax(0.5);
    null_highest_ = (null * null_mean_.cwiseInverse().asDiagonal()).rowwise().maxCoeff();
  }

  SeriesScore score_of(std::size_t k) {
    const SeriesFit& fit = gains_.fits[k];
    const SeriesCandidate& candidate = candidates_[k];
    const double gain = gains_.values[static_cast<Eigen::Index>(k)];
    const double noise = null_mean_[static_cast<Eigen::Index>(k)];
    const double p = share_of_noise(null_highest_, gain / noise);
    result_.p = std::min(result_.p, p);
    const double width = bound_width(fit.deviation, 1, candidate.two_sided, noise);
    const double least = candidate.two_sided ? fit.amplitude - width : 0.0;
    const double most = fit.amplitude + width;
    const double squares = responses_.squares(k);
    return {candidate.effect,
            gain,
            noise,
            p,
            std::min(least * candidate.strength, most * candidate.strength),
            std::max(least * candidate.strength, most * candidate.strength),
            most <= kLargestAmplitude && least >= -kLargestAmplitude,
            needed(squares, noise),
            responses_.telling(responses_.of(k))};
  }

  // Vesicles like these that show what has the square of this size, noise being as it is.
  double needed(double squares, double noise) const {
    return static_cast<double>(data_.vesicles().size()) * kSeen * kSeen * std::max(1.0, noise) /
           std::max(squares, 1e-12);
  }

  std::vector<std::string> names_of(const std::vector<std::size_t>& members) const {
    std::vector<std::string> names;
    for (const std::size_t k : members) names.push_back(candidates_[k].effect);
    return names;
  }

  void judge() {
    const bool significant = result_.p <= request_.false_alarms;
    const Vec calibrated = gains_.values.cwiseQuotient(null_mean_);
    Eigen::Index best;
    calibrated.maxCoeff(&best);
    const auto b = static_cast<std::size_t>(best);
    result_.trend_p = share_of_noise(
        null_trend_, significant
                         ? trend_left(blocks_of(data_), {&ensembles_.base, &ensembles_.changed[b]},
                                      gains_.fits[b])
                         : gains_.trend);
    if (result_.trend_p <= kTrendLevel * request_.false_alarms) {
      result_.finding = Finding::unnamed;
      if (significant) result_.named = {{candidates_[b].effect}};
      return;
    }
    if (!significant) {
      const bool blind =
          std::none_of(result_.scores.begin(), result_.scores.end(),
                       [&](const SeriesScore& s) { return s.vesicles <= result_.vesicles; });
      result_.finding = blind ? Finding::not_identifiable : Finding::none;
      return;
    }
    for (const auto& members : classes_) {
      const auto most = *std::max_element(
          members.begin(), members.end(),
          [&](std::size_t a, std::size_t b) { return calibrated[a] < calibrated[b]; });
      const bool own = std::count(members.begin(), members.end(), best) > 0;
      const double behind = gains_.values[best] - gains_.values[static_cast<Eigen::Index>(most)];
      if (own) result_.named.insert(result_.named.begin(), names_of(members));
      if (own || behind >= kTelling * std::max(1.0, null_mean_[best])) continue;
      result_.named.push_back(names_of(members));
      const Vec difference = gains_.fits[b].amplitude * responses_.beyond(b, most);
      result_.ties.push_back({candidates_[b].effect, candidates_[most].effect,
                              needed(responses_.squares(difference), null_mean_[best]),
                              responses_.telling(difference)});
    }
    result_.finding = result_.named.size() > 1 || result_.named.front().size() > 1
                          ? Finding::ambiguous
                          : Finding::named;
  }

  const MeasuredVesicles& data_;
  const std::vector<History>& base_;
  const std::vector<SeriesCandidate>& candidates_;
  const SeriesRequest& request_;
  const Ensembles ensembles_;
  const Gains gains_;
  const Responses responses_;
  const Classes classes_;
  Vec null_mean_, null_highest_, null_trend_;
  SeriesExplanation result_;
};

}  // namespace

void refuse_vesicles(const MeasuredVesicles& data) {
  if (data.vesicles().size() < 3)
    throw InputError("series need three vesicles at least, to know how they scatter");
}

SeriesExplanation explain_series(const MeasuredVesicles& data, const std::vector<History>& base,
                                 const std::vector<SeriesCandidate>& candidates,
                                 const SeriesRequest& request) {
  refuse(data, base, candidates);
  SeriesRequest covered = request;
  covered.unit.least = shortest_unit(data, base, candidates);
  if (covered.unit.least > request.unit.start * request.unit.factor)
    throw InputError("series: the runs end before the last measurement, whatever D is");
  return SeriesSearch(data, base, candidates, covered).run();
}

}  // namespace traceraft
