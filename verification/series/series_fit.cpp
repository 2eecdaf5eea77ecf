#include "verification/series/series_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "backends/nlopt/minimise.hpp"

namespace traceraft {
namespace {

constexpr double kRoundingVariance = 1 / 12.0;  // of a whole number
constexpr double kLeastScatter = 0.003, kLargestScatter = 1;
constexpr int kTrendDegree = 3;
constexpr int kRounds = 3, kNewtonSteps = 4;

constexpr std::size_t index(Quantity quantity) {
  return static_cast<std::size_t>(quantity);
}

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

// The fit from one start: steps of Gauss and Newton for the unit and the amplitude, the scatter
// between them.
class Fitter {
 public:
  Fitter(const std::vector<SeriesBlock>& blocks, const SeriesModel& model, const UnitRange& unit,
         const SeriesFit& start)
      : blocks_(blocks),
        model_(model),
        centre_(std::log(unit.start)),
        least_(std::min(unit.lowest(), unit.highest())),  // the runs may end before what is drawn
        most_(unit.highest()),
        weight_(1 / (unit.deviation() * unit.deviation())),
        fit_(start) {
    fit_.ln_unit = std::max(fit_.ln_unit, least_);
  }

  SeriesFit run() {
    for (int k = 0; k < kRounds; ++k) {
      for (int step = 0; step < kNewtonSteps; ++step) improve_mean();
      improve_scatter();
    }
    return fit_;
  }

 private:
  Vec residual() const { return traceraft::residual(blocks_, model_, fit_); }

  // A step of Gauss and Newton, halved until it is none backwards.
  void improve_mean() {
    const SeriesMetric metric(blocks_, *model_.base, fit_.ln_unit, fit_.scatter);
    const Vec r = residual(), u = unit_response(blocks_, *model_.base, fit_.ln_unit);
    const double uu = metric.product(u, u) + weight_;
    const double ur = metric.product(u, r) + weight_ * (centre_ - fit_.ln_unit);
    double step_a = 0, step_u = ur / uu;
    if (model_.changed != nullptr) {
      const Vec e = response(blocks_, *model_.base, *model_.changed, fit_.ln_unit);
      const double ue = metric.product(u, e), er = metric.product(e, r);
      const double own = metric.product(e, e) + 1e-9 - ue * ue / uu;
      fit_.deviation = 1 / std::sqrt(own);
      const double lowest = model_.two_sided ? -kLargestAmplitude : 0.0;
      step_a = std::clamp(fit_.amplitude + (er - ue * ur / uu) / own, lowest, kLargestAmplitude) -
               fit_.amplitude;
      step_u = (ur - ue * step_a) / uu;
    }
    const SeriesFit before = fit_;
    const double least = metric.product(r, r) + penalty();
    for (double share = 1; share > 0.1; share *= 0.5) {
      fit_.amplitude = before.amplitude + share * step_a;
      fit_.ln_unit = std::clamp(before.ln_unit + share * step_u, least_, most_);
      const Vec now = residual();
      if (metric.product(now, now) + penalty() <= least) return;
    }
    fit_.amplitude = before.amplitude;
    fit_.ln_unit = before.ln_unit;
  }

  // D is known: within the factor with 95 % confidence.
  double penalty() const { return weight_ * (fit_.ln_unit - centre_) * (fit_.ln_unit - centre_); }

  void improve_scatter() {
    const Vec r = residual();
    const auto scatter_at = [](const std::vector<double>& x) {
      SeriesScatter scatter;
      for (std::size_t q = 0; q < 3; ++q) {
        scatter.vesicle[q] = std::exp(x[q]);
        scatter.look[q] = std::exp(x[3 + q]);
      }
      return scatter;
    };
    std::vector<double> start;
    for (const auto& values : {fit_.scatter.vesicle, fit_.scatter.look})
      for (const double s : values) start.push_back(std::log(s));
    const double low = std::log(kLeastScatter), high = std::log(kLargestScatter);
    const Minimum found =
        minimise({[&](const std::vector<double>& x) {
                    const SeriesMetric metric(blocks_, *model_.base, fit_.ln_unit, scatter_at(x));
                    return metric.product(r, r) + metric.log_determinant();
                  },
                  start, std::vector<double>(6, low), std::vector<double>(6, high),
                  std::vector<double>(6, 0.3), 1e-3, 300});
    fit_.scatter = scatter_at(found.x);
    fit_.deviance = found.value + penalty();
  }

  const std::vector<SeriesBlock>& blocks_;
  const SeriesModel& model_;
  const double centre_, least_, most_, weight_;
  SeriesFit fit_;
};

}  // namespace

double UnitRange::deviation() const {
  constexpr double k95 = 2;
  return std::log(factor) / k95;
}
double UnitRange::lowest() const {
  return std::max(std::log(start) - reach * std::log(factor), std::log(least));
}
double UnitRange::highest() const {
  return std::log(start) + reach * std::log(factor);
}

std::vector<SeriesBlock> blocks_of(const MeasuredVesicles& data) {
  std::vector<SeriesBlock> blocks;
  for (const auto& [first, last] : data.vesicles())
    for (const Quantity quantity : kQuantities) {
      std::vector<double> t, y, variance;
      for (std::size_t i = first; i < last; ++i) {
        const Measurement& m = data.measurements[i];
        const double value = m.of(quantity).value_or(0);
        if (!(value > 0) || !(m.time > 0)) continue;
        const double sigma2 = std::pow(m.sigma_of(quantity), 2) +
                              (quantity == Quantity::rafts ? kRoundingVariance : 0.0);
        t.push_back(std::log(m.time));
        y.push_back(logarithm_of(quantity, value));
        variance.push_back(sigma2 / (value * value));
      }
      const auto vec = [](const std::vector<double>& v) {
        return Vec(Eigen::Map<const Vec>(v.data(), static_cast<Eigen::Index>(v.size())));
      };
      if (!t.empty()) blocks.push_back({quantity, vec(t), vec(y), vec(variance)});
    }
  return blocks;
}

SeriesFit fit_series(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
                     const UnitRange& unit) {
  SeriesFit best, start;
  best.deviance = std::numeric_limits<double>::infinity();
  start.scatter = {{0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}};
  // Several starts: where a plateau is reached, time makes no difference.
  for (const double share : {-0.5, 0.0, 0.5}) {
    start.ln_unit = std::log(unit.start) + share * std::log(unit.factor);
    const SeriesFit fit = Fitter(blocks, model, unit, start).run();
    if (fit.deviance < best.deviance) best = fit;
  }
  return best;
}

SeriesFit fit_series(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
                     const UnitRange& unit, const SeriesFit& near) {
  return Fitter(blocks, model, unit, near).run();
}

SeriesMetric::SeriesMetric(const std::vector<SeriesBlock>& blocks, const RunCurves& base,
                           double ln_unit, const SeriesScatter& scatter) {
  Eigen::Index next = 0;
  for (const SeriesBlock& block : blocks) {
    const std::size_t q = index(block.quantity);
    Vec inverse(block.values.size());
    for (Eigen::Index i = 0; i < inverse.size(); ++i)
      inverse[i] = 1 / (block.variance[i] + scatter.look[q] * scatter.look[q] +
                        base.variance(block.quantity, block.ln_t[i] - ln_unit));
    blocks_.push_back(
        {block.quantity, next, inverse.size(), scatter.vesicle[q] * scatter.vesicle[q], inverse});
    next += inverse.size();
  }
}

double SeriesMetric::product(const Vec& u, const Vec& v, std::optional<Quantity> only) const {
  double sum = 0;
  for (const Block& block : blocks_) {
    if (only && block.quantity != *only) continue;
    const auto a = u.segment(block.first, block.count), b = v.segment(block.first, block.count);
    const double own = block.shared / (1 + block.shared * block.inverse.sum());
    sum += (a.array() * b.array() * block.inverse.array()).sum() -
           own * a.dot(block.inverse) * b.dot(block.inverse);
  }
  return sum;
}

double SeriesMetric::log_determinant() const {
  double sum = 0;
  for (const Block& block : blocks_)
    sum += std::log1p(block.shared * block.inverse.sum()) - block.inverse.array().log().sum();
  return sum;
}

Vec residual(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
             const SeriesFit& fit) {
  return per_look(blocks, [&](const SeriesBlock& block, Eigen::Index i) {
    const double t = block.ln_t[i] - fit.ln_unit;
    const double mean = model.base->mean(block.quantity, t);
    const double change =
        model.changed != nullptr ? model.changed->mean(block.quantity, t) - mean : 0.0;
    return block.values[i] - mean - fit.amplitude * change;
  });
}

namespace {

// (ln t)^power of one quantity, around the middle of all looks.
Vec power_of_time(const std::vector<SeriesBlock>& blocks, Quantity quantity, int power) {
  double sum = 0, count = 0;
  for (const SeriesBlock& block : blocks) {
    sum += block.ln_t.sum();
    count += static_cast<double>(block.ln_t.size());
  }
  return per_look(blocks, [&](const SeriesBlock& block, Eigen::Index i) {
    return block.quantity == quantity ? std::pow(block.ln_t[i] - sum / count, power) : 0.0;
  });
}

}  // namespace

double trend_left(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
                  const SeriesFit& fit) {
  const SeriesMetric metric(blocks, *model.base, fit.ln_unit, fit.scatter);
  std::vector<Vec> trends;
  for (const Quantity quantity : kQuantities)
    for (int power = 0; power <= kTrendDegree; ++power) {
      Vec trend = power_of_time(blocks, quantity, power);
      for (const Vec& before : trends) trend -= metric.product(before, trend) * before;
      const double norm = std::sqrt(metric.product(trend, trend));
      if (norm > 1e-6) trends.push_back(trend / norm);
    }
  const Vec r = residual(blocks, model, fit);
  double squares = 0;
  for (const Vec& trend : trends) squares += std::pow(metric.product(trend, r), 2);
  return squares;
}

std::vector<SeriesOffset> offsets(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
                                  const SeriesFit& fit) {
  const SeriesMetric metric(blocks, *model.base, fit.ln_unit, fit.scatter);
  const Vec r = residual(blocks, model, fit);
  std::vector<SeriesOffset> all;
  for (const Quantity quantity : kQuantities) {
    const Vec level = power_of_time(blocks, quantity, 0);
    Vec slope = power_of_time(blocks, quantity, 1);
    const double levels = metric.product(level, level);
    if (!(levels > 0)) continue;
    slope -= metric.product(level, slope) / levels * level;
    const double slopes = std::max(metric.product(slope, slope), 1e-12);
    const double by_level = metric.product(level, r), by_slope = metric.product(slope, r);
    all.push_back({quantity, by_level / levels, by_level / std::sqrt(levels), by_slope / slopes,
                   by_slope / std::sqrt(slopes)});
  }
  return all;
}

Vec response(const std::vector<SeriesBlock>& blocks, const RunCurves& base,
             const RunCurves& changed, double ln_unit) {
  return per_look(blocks, [&](const SeriesBlock& block, Eigen::Index i) {
    const double t = block.ln_t[i] - ln_unit;
    return changed.mean(block.quantity, t) - base.mean(block.quantity, t);
  });
}

Vec unit_response(const std::vector<SeriesBlock>& blocks, const RunCurves& base, double ln_unit) {
  return per_look(blocks, [&](const SeriesBlock& block, Eigen::Index i) {
    return -base.slope(block.quantity, block.ln_t[i] - ln_unit);
  });
}

}  // namespace traceraft
