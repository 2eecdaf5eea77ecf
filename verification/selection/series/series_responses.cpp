#include "verification/selection/series/series_responses.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::selection {
namespace {

// Responses that correlate more are one class.
constexpr double kAlike = 0.8;

SeriesResponse minus(const SeriesResponse& a, const SeriesResponse& b) {
  return {a.looks - b.looks, a.unit - b.unit};
}

}  // namespace

SeriesResponse operator*(double factor, const SeriesResponse& response) {
  return {factor * response.looks, factor * response.unit};
}

SeriesResponses::SeriesResponses(const std::vector<likelihood::ObservedSeries>& blocks,
                                 const SeriesCurves& curves, const std::vector<std::size_t>& levels,
                                 const likelihood::EnsembleFit& fit,
                                 const likelihood::UnitPrior& unit)
    : metric_(likelihood::metric_of(blocks, {&curves.base}, fit)),
      by_unit_{likelihood::unit_response(blocks, curves.base, fit.ln_unit), 1 / unit.deviation} {
  const double squares = product(by_unit_, by_unit_);
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const SeriesResponse e{
        likelihood::response(blocks, curves.base, curves.level(k, levels[k]), fit.ln_unit)};
    own_.push_back(minus(e, product(by_unit_, e) / squares * by_unit_));
  }
}

double SeriesResponses::product(const SeriesResponse& a, const SeriesResponse& b) const {
  return metric_.product(a.looks, b.looks) + a.unit * b.unit;
}

SeriesResponse SeriesResponses::beyond(std::size_t k, std::size_t j) const {
  const double jj = product(own_[j], own_[j]);
  return jj > 0 ? minus(own_[k], product(own_[j], own_[k]) / jj * own_[j]) : own_[k];
}

double SeriesResponses::correlation(std::size_t j, std::size_t k) const {
  const double norm = std::sqrt(product(own_[j], own_[j]) * product(own_[k], own_[k]));
  return norm > 0 ? product(own_[j], own_[k]) / norm : 0;
}

SeriesProducts SeriesResponses::products(const SeriesResponse& own) const {
  const Vec& u = by_unit_.looks;
  const Vec e = own.looks - own.unit / by_unit_.unit * u;
  return {metric_.product(e, e), metric_.product(u, e), metric_.product(u, u),
          by_unit_.unit * by_unit_.unit};
}

observations::Quantity SeriesResponses::telling(const SeriesResponse& e) const {
  return *std::max_element(observations::kQuantities.begin(), observations::kQuantities.end(),
                           [&](observations::Quantity a, observations::Quantity b) {
                             return metric_.product(e.looks, e.looks, a) <
                                    metric_.product(e.looks, e.looks, b);
                           });
}

SeriesClasses classes_of(const SeriesResponses& responses, std::size_t effects) {
  SeriesClasses classes;
  for (std::size_t k = 0; k < effects; ++k) {
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

}  // namespace traceraft::selection
