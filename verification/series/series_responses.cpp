#include "verification/series/series_responses.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft {
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

SeriesResponses::SeriesResponses(const std::vector<SeriesBlock>& blocks, const SeriesCurves& curves,
                                 const SeriesFit& fit, const UnitRange& unit)
    : metric_(blocks, known_variance(blocks, curves.base, fit.ln_unit), fit.scatter),
      by_unit_{unit_response(blocks, curves.base, fit.ln_unit), 1 / unit.deviation()} {
  const double squares = product(by_unit_, by_unit_);
  for (const RunCurves& changed : curves.changed) {
    const SeriesResponse e{response(blocks, curves.base, changed, fit.ln_unit)};
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

// Of f times as many vesicles the looks' products are f times as large: f ee − f² ue²/(f uu + w)
// with what the effect does, e, what another D does, u, and what is known of D, w.
double SeriesResponses::times_needed(const SeriesResponse& response, double square) const {
  const Vec& u = by_unit_.looks;
  const double w = by_unit_.unit * by_unit_.unit;
  const Vec e = response.looks - response.unit / by_unit_.unit * u;
  const double ee = metric_.product(e, e), ue = metric_.product(u, e), uu = metric_.product(u, u);
  const double a = std::max(ee * uu - ue * ue, 0.0), b = ee * w - square * uu, c = square * w;
  const double root = std::sqrt(b * b + 4 * a * c);
  // Of the two ways to write the positive root of a f² + b f = c the one without cancellation.
  const double f =
      b >= 0 ? 2 * c / std::max(b + root, 1e-300) : (root - b) / std::max(2 * a, 1e-300);
  return std::min(f, 1e12);
}

Quantity SeriesResponses::telling(const SeriesResponse& e) const {
  return *std::max_element(kQuantities.begin(), kQuantities.end(), [&](Quantity a, Quantity b) {
    return metric_.product(e.looks, e.looks, a) < metric_.product(e.looks, e.looks, b);
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

}  // namespace traceraft
