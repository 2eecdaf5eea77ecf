#include "verification/series/series_responses.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft {
namespace {

// Responses that correlate more are one class.
constexpr double kAlike = 0.8;

}  // namespace

SeriesResponses::SeriesResponses(const std::vector<SeriesBlock>& blocks, const SeriesCurves& curves,
                                 const SeriesFit& fit)
    : metric_(blocks, curves.base, fit.ln_unit, fit.scatter) {
  const Vec unit = unit_response(blocks, curves.base, fit.ln_unit);
  const double uu = metric_.product(unit, unit) + 1e-12;
  for (const RunCurves& changed : curves.changed) {
    Vec e = response(blocks, curves.base, changed, fit.ln_unit);
    e -= metric_.product(unit, e) / uu * unit;
    own_.push_back(std::move(e));
  }
}

Vec SeriesResponses::beyond(std::size_t k, std::size_t j) const {
  const double jj = squares(j);
  return jj > 0 ? Vec(own_[k] - metric_.product(own_[j], own_[k]) / jj * own_[j]) : own_[k];
}

double SeriesResponses::correlation(std::size_t j, std::size_t k) const {
  const double norm = std::sqrt(squares(j) * squares(k));
  return norm > 0 ? metric_.product(own_[j], own_[k]) / norm : 0;
}

Quantity SeriesResponses::telling(const Vec& e) const {
  return *std::max_element(kQuantities.begin(), kQuantities.end(), [&](Quantity a, Quantity b) {
    return metric_.product(e, e, a) < metric_.product(e, e, b);
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
