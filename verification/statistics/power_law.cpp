#include "verification/statistics/power_law.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "backends/nlopt/minimise.hpp"

namespace traceraft::statistics {
namespace {

// For a given t0 the rest is a line through logarithms.
PowerLaw law_from(const Points& points, double t0) {
  Points shifted;
  for (const auto& [t, y] : points) shifted.emplace_back(t - t0, y);
  const Line line = fit_power_law(shifted);
  double squares = 0;
  for (const auto& [t, y] : shifted)
    squares += std::pow(std::log(y) - line.intercept - line.slope * std::log(t), 2);
  return {std::exp(line.intercept), t0, line.slope,
          std::sqrt(squares / static_cast<double>(points.size() - 3))};
}

}  // namespace

Line fit_line(const Points& points) {
  const double count = static_cast<double>(points.size());
  double x_mean = 0, y_mean = 0, xx = 0, xy = 0;
  for (const auto& [x, y] : points) {
    x_mean += x / count;
    y_mean += y / count;
  }
  for (const auto& [x, y] : points) {
    xx += (x - x_mean) * (x - x_mean);
    xy += (x - x_mean) * (y - y_mean);
  }
  if (!(xx > 0)) throw std::runtime_error("a line needs two different points");
  return {xy / xx, y_mean - xy / xx * x_mean};
}

Line fit_power_law(const Points& points) {
  Points logarithms;
  for (const auto& [x, y] : points) logarithms.emplace_back(std::log(x), std::log(y));
  return fit_line(logarithms);
}

double PowerLaw::at(double t) const {
  return c * std::pow(t - t0, b);
}

double first_time(const Points& points) {
  double first = HUGE_VAL;
  for (const auto& point : points) first = std::min(first, point.first);
  return first;
}

PowerLaw fit_power_law_from(const Points& points, double latest) {
  const double first = first_time(points), lower = kEarliestOrigin * first, upper = latest * first;
  // Two valleys are possible: one where t0 explains the first points alone.
  PowerLaw best = law_from(points, 0);
  for (const double start : {-first, 0.0, 0.5 * first}) {
    const nlopt::Minimum found = nlopt::minimise(
        {[&](const std::vector<double>& x) { return law_from(points, x[0]).scatter; },
         {std::min(start, upper)},
         {lower},
         {upper},
         {0.2 * first}});
    if (found.value < best.scatter) best = law_from(points, found.x[0]);
  }
  return best;
}

ObservedOrder observed_order(const Points& levels) {
  const auto between = [&](std::size_t fine) {
    const auto& [coarse_size, coarse_error] = levels[fine - 1];
    return std::log(coarse_error / levels[fine].second) /
           std::log(coarse_size / levels[fine].first);
  };
  const std::size_t last = levels.size() - 1;
  const double order = between(last);
  return {order, levels.size() > 2 ? std::fabs(order - between(last - 1)) : 0};
}

}  // namespace traceraft::statistics
