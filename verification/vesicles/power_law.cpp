#include "verification/vesicles/power_law.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "backends/nlopt/minimise.hpp"

namespace traceraft {
namespace {

double first_time(const Points& points) {
  double first = HUGE_VAL;
  for (const auto& point : points) first = std::min(first, point.first);
  return first;
}

// Of t0.
double earliest_start(const Points& points) {
  return -10 * first_time(points);
}

constexpr double kLatest = 1e-3;  // t0 is that much before the first time, in units of it
constexpr int kResampled = 400;
constexpr double kConfidence = 0.95;
constexpr std::size_t kLeastPoints = 4;
constexpr int kLeastVesicles = 3;
constexpr double kLeastPerimeter = 1e-3;  // of rafts, over the radius

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

// Four points at three different times at least: three parameters.
bool enough(const Points& points) {
  std::set<double> times;
  for (const auto& point : points) times.insert(point.first);
  return points.size() >= kLeastPoints && times.size() >= 3;
}

Interval exponential(const Interval& logarithms) {
  return {std::exp(logarithms.low), std::exp(logarithms.high)};
}

// The intervals of all three parameters from the same samples; t0 by how long before the first look
// it is, which is positive, as c is.
template <class Sample>
FittedLaw with_intervals(const Sample& points_of, int count) {
  std::vector<int> all;
  for (int i = 0; i < count; ++i) all.push_back(i);
  const Points points = points_of(all);
  FittedLaw fitted{fit_power_law_from(points),      {},   {}, {}, false,
                   static_cast<int>(points.size()), count};
  const double first = first_time(points);
  const auto parameters_of = [&](const PowerLaw& law) {
    const double before = std::max(first - law.t0, kLatest * first);  // others may be seen later
    return std::vector<double>{std::log(law.c), std::log(before), law.b};
  };
  const std::vector<double> centre = parameters_of(fitted.law);
  const std::vector<Interval> intervals =
      bootstrap_all(count, kResampled, kConfidence, 1, [&](const std::vector<int>& sample) {
        const Points drawn = points_of(sample);
        return enough(drawn) ? parameters_of(fit_power_law_from(drawn)) : centre;
      });
  const auto widened = [&](std::size_t k) {
    return widened_for_few(intervals[k], centre[k], count);
  };
  fitted.c = exponential(widened(0));
  const Interval before = exponential(widened(1));
  fitted.t0 = {std::max(first - before.high, earliest_start(points)), first - before.low};
  fitted.t0_open = fitted.t0.low < 0.99 * earliest_start(points);
  fitted.b = widened(2);
  return fitted;
}

}  // namespace

double PowerLaw::at(double t) const {
  return c * std::pow(t - t0, b);
}

PowerLaw fit_power_law_from(const Points& points) {
  const double first = first_time(points), lower = earliest_start(points),
               upper = first * (1 - kLatest);
  // Two valleys are possible: one where t0 explains the first points alone.
  PowerLaw best = law_from(points, 0);
  for (const double start : {-first, 0.0, 0.5 * first}) {
    const Minimum found =
        minimise({[&](const std::vector<double>& x) { return law_from(points, x[0]).scatter; },
                  {start},
                  {lower},
                  {upper},
                  {0.2 * first}});
    if (found.value < best.scatter) best = law_from(points, found.x[0]);
  }
  return best;
}

std::optional<FittedLaw> fit_measurements(const MeasuredVesicles& data, const Window& window) {
  std::vector<Points> vesicles;
  Points all;
  for (const auto& [begin, end] : data.vesicles()) {
    Points points;
    for (std::size_t i = begin; i < end; ++i) {
      const Measurement& m = data.measurements[i];
      const auto& y = m.of(Quantity::perimeter);
      if (window.contains(m.time) && m.time > 0 && y && *y > 0) points.emplace_back(m.time, *y);
    }
    all.insert(all.end(), points.begin(), points.end());
    if (!points.empty()) vesicles.push_back(points);
  }
  if (!enough(all) || static_cast<int>(vesicles.size()) < kLeastVesicles) return std::nullopt;
  return with_intervals(
      [&](const std::vector<int>& sample) {
        Points points;
        for (const int k : sample)
          points.insert(points.end(), vesicles[k].begin(), vesicles[k].end());
        return points;
      },
      static_cast<int>(vesicles.size()));
}

std::optional<FittedLaw> fit_runs(const std::vector<History>& runs,
                                  const std::vector<double>& times, const Window& window) {
  const auto have_rafts = [&](double t) {
    const auto none = std::count_if(runs.begin(), runs.end(), [&](const History& run) {
      return run.at(Quantity::perimeter, t) < kLeastPerimeter;
    });
    return 2 * static_cast<std::size_t>(none) < runs.size();
  };
  std::vector<double> within;
  for (const double t : times)
    if (window.contains(t) && have_rafts(t)) within.push_back(t);
  if (within.size() < kLeastPoints || static_cast<int>(runs.size()) < kLeastVesicles)
    return std::nullopt;
  return with_intervals(
      [&](const std::vector<int>& sample) {
        Points points;
        for (const double t : within) {
          double sum = 0;
          for (const int k : sample)
            sum += logarithm_of(Quantity::perimeter, runs[k].at(Quantity::perimeter, t));
          points.emplace_back(t, std::exp(sum / static_cast<double>(sample.size())));
        }
        return points;
      },
      static_cast<int>(runs.size()));
}

}  // namespace traceraft
