#include "verification/likelihood/drawn_vesicles.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/random.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::likelihood {
namespace {

constexpr std::uint64_t kNext = 1ull << 32;  // number of one look

// One quantity of one look. `look`: its number in all random streams.
double drawn_value(const observations::StatedError& stated, double own,
                   observations::Quantity quantity, std::uint64_t replicate, std::uint64_t look) {
  const double value = std::exp(stated.drawn(own, [&](std::uint64_t k) {
    return normal_random(replicate, statistics::replicate_stream::stated_error, look + k * kNext);
  }));
  return quantity == observations::Quantity::rafts ? std::max(1.0, std::round(value)) : value;
}

}  // namespace

double ModelRuns::logarithm(const Vec& weights, observations::Quantity quantity, double t) const {
  double own = 0;
  for (std::size_t k = 0; k < runs->size(); ++k)
    own += weights[static_cast<Eigen::Index>(k)] *
           observations::logarithm_of(quantity, (*runs)[k].at(quantity, t));
  if (from == nullptr) return own;
  return own + to->mean(quantity, std::log(t)) - from->mean(quantity, std::log(t));
}

observations::MeasuredVesicles drawn_vesicles(const observations::MeasuredVesicles& data,
                                              const observations::StatedErrors& errors,
                                              const ModelRuns& model, const EnsembleFit& fit,
                                              std::uint64_t replicate) {
  observations::MeasuredVesicles drawn = data;
  std::uint64_t vesicle = 0, look = 0;
  for (const auto& [first, last] : data.vesicles()) {
    const Vec weights = weights_of_another_run(model.runs->size(), replicate,
                                               statistics::replicate_stream::run, vesicle);
    for (std::size_t i = first; i < last; ++i)
      for (const observations::Quantity quantity : observations::kQuantities) {
        const auto q = observations::index_of(quantity);
        const observations::Measurement& m = data.measurements[i];
        const double measured = m.of(quantity).value_or(0);
        if (!(measured > 0) || !(m.time > 0)) continue;  // it says nothing
        ++look;
        const double t = m.time / fit.seconds_per_unit();
        double& value = drawn.measurements[i].values[q].emplace(0);
        if (model.logarithm(weights, observations::Quantity::rafts, t) < std::log(kLeastRafts))
          continue;
        const double own =
            model.logarithm(weights, quantity, t) +
            fit.scatter.vesicle[q] *
                normal_random(replicate, statistics::replicate_stream::vesicle, 3 * vesicle + q) +
            fit.scatter.look[q] *
                normal_random(replicate, statistics::replicate_stream::observation, look);
        value = drawn_value(errors.of(m, quantity), own, quantity, replicate, look);
        drawn.measurements[i].sigma[q] =
            m.sigma_of(quantity) * std::pow(value / measured, errors.power(quantity));
      }
    ++vesicle;
  }
  return drawn;
}

UnitPrior drawn_unit(const EnsembleFit& fit, const UnitPrior& unit, std::uint64_t replicate) {
  UnitPrior drawn = unit;
  if (std::isfinite(unit.deviation))
    drawn.drawn =
        fit.ln_unit - std::log(unit.start) +
        unit.deviation * normal_random(replicate, statistics::replicate_stream::known_unit, 0);
  return drawn;
}

}  // namespace traceraft::likelihood
