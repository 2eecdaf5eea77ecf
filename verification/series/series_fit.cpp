#include "verification/series/series_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "backends/nlopt/minimise.hpp"
#include "verification/measure/fit.hpp"

namespace traceraft {
namespace {

constexpr double kLeastScatter = 0.003, kLargestScatter = 1;
constexpr int kRounds = 3, kNewtonSteps = 4;

constexpr std::size_t index(Quantity quantity) {
  return static_cast<std::size_t>(quantity);
}

// The fit from one start: steps of Gauss and Newton for the unit and the amplitude, the scatter
// between them.
class Fitter {
 public:
  Fitter(const std::vector<SeriesBlock>& blocks, const SeriesModel& model, const UnitRange& unit,
         const SeriesFit& start)
      : blocks_(blocks),
        model_(model),
        centre_(std::log(unit.start) + unit.drawn),
        least_(unit.lowest()),
        most_(unit.highest()),
        weight_(1 / (unit.deviation() * unit.deviation())),
        fit_(start) {
    fit_.ln_unit = std::max(fit_.ln_unit, least_);
    for (const SeriesBlock& block : blocks) measured_[index(block.quantity)] = true;
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
    const SeriesMetric metric = metric_of(blocks_, model_, fit_);
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

  // That of each quantity by itself: those of others are independent of it.
  void improve_scatter() {
    const Vec r = residual();
    const Vec known =
        known_variance(blocks_, *model_.base, fit_.ln_unit, expected(blocks_, model_, fit_));
    fit_.deviance = penalty();
    for (const Quantity quantity : kQuantities) {
      if (!measured_[index(quantity)]) continue;
      double &vesicle = fit_.scatter.vesicle[index(quantity)],
             &look = fit_.scatter.look[index(quantity)];
      SeriesScatter scatter = fit_.scatter;
      const auto deviance = [&](const std::vector<double>& x) {
        scatter.vesicle[index(quantity)] = std::exp(x[0]);
        scatter.look[index(quantity)] = std::exp(x[1]);
        const SeriesMetric metric(blocks_, known, scatter, quantity);
        return metric.product(r, r) + metric.log_determinant();
      };
      const double low = std::log(kLeastScatter), high = std::log(kLargestScatter);
      const Minimum found = minimise({deviance,
                                      {std::log(vesicle), std::log(look)},
                                      {low, low},
                                      {high, high},
                                      {0.3, 0.3},
                                      1e-3,
                                      100});
      vesicle = std::exp(found.x[0]);
      look = std::exp(found.x[1]);
      fit_.deviance += found.value;
    }
  }

  const std::vector<SeriesBlock>& blocks_;
  const SeriesModel& model_;
  const double centre_, least_, most_, weight_;
  std::array<bool, kQuantities.size()> measured_{};
  SeriesFit fit_;
};

}  // namespace

double UnitRange::deviation() const {
  return std::log(factor) / kNormal95;
}
double UnitRange::lowest() const {
  return std::max(std::log(start) - reach * std::log(factor), std::log(least));
}
double UnitRange::highest() const {
  return std::log(start) + reach * std::log(factor);
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

Vec expected(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
             const SeriesFit& fit) {
  return per_look(blocks, [&](const SeriesBlock& block, Eigen::Index i) {
    const double t = block.ln_t[i] - fit.ln_unit;
    const double mean = model.base->mean(block.quantity, t);
    const double change =
        model.changed != nullptr ? model.changed->mean(block.quantity, t) - mean : 0.0;
    return mean + fit.amplitude * change;
  });
}

SeriesMetric metric_of(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
                       const SeriesFit& fit) {
  return {blocks, known_variance(blocks, *model.base, fit.ln_unit, expected(blocks, model, fit)),
          fit.scatter};
}

Vec residual(const std::vector<SeriesBlock>& blocks, const SeriesModel& model,
             const SeriesFit& fit) {
  return per_look(blocks, expected(blocks, model, fit),
                  [](const SeriesBlock& block, Eigen::Index i, double mean) {
                    return block.values[i] - mean -
                           block.stated[static_cast<std::size_t>(i)].bias(mean);
                  });
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
