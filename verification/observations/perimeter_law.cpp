#include "verification/observations/perimeter_law.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "verification/statistics/sample.hpp"

namespace traceraft::observations {
namespace {

constexpr int kResampled = 400;
constexpr double kConfidence = 0.95;
constexpr std::size_t kLeastPoints = 4;
constexpr int kLeastVesicles = 3;
constexpr double kLeastPerimeter = 1e-3;  // of rafts, over the radius

// Four points at three different times at least: three parameters.
bool enough(const statistics::Points& points) {
  std::set<double> times;
  for (const auto& point : points) times.insert(point.first);
  return points.size() >= kLeastPoints && times.size() >= 3;
}

statistics::Interval exponential(const statistics::Interval& logarithms) {
  return {std::exp(logarithms.low), std::exp(logarithms.high)};
}

// The intervals of all three parameters from the same samples; t0 by how long before the first look
// it is, which is positive, as c is.
template <class PointsOf>
FittedLaw with_intervals(const PointsOf& points_of, int count) {
  const statistics::Points points =
      points_of(statistics::each_once(static_cast<std::size_t>(count)));
  FittedLaw fitted{statistics::fit_power_law_from(points), {},   {}, {}, false,
                   static_cast<int>(points.size()),        count};
  const double first = statistics::first_time(points);
  const auto parameters_of = [&](const statistics::PowerLaw& law) {
    const double before = std::max(
        first - law.t0, (1 - statistics::kLatestOrigin) * first);  // others may be seen later
    return std::vector<double>{std::log(law.c), std::log(before), law.b};
  };
  const std::vector<double> centre = parameters_of(fitted.law);
  const std::vector<statistics::Interval> intervals = statistics::bootstrap_all(
      count, kResampled, kConfidence, 1, [&](const std::vector<int>& sample) {
        const statistics::Points drawn = points_of(sample);
        return enough(drawn) ? parameters_of(statistics::fit_power_law_from(drawn)) : centre;
      });
  const auto widened = [&](std::size_t k) {
    return statistics::widened_for_few(intervals[k], centre[k], count);
  };
  fitted.c = exponential(widened(0));
  const statistics::Interval before = exponential(widened(1));
  fitted.t0 = {std::max(first - before.high, statistics::kEarliestOrigin * first),
               first - before.low};
  fitted.t0_open = fitted.t0.low < 0.99 * statistics::kEarliestOrigin * first;
  fitted.b = widened(2);
  return fitted;
}

}  // namespace

std::optional<FittedLaw> fit_measurements(const MeasuredVesicles& data,
                                          const statistics::Window& window) {
  std::vector<statistics::Points> vesicles;
  statistics::Points all;
  for (const auto& [begin, end] : data.vesicles()) {
    statistics::Points points;
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
        statistics::Points points;
        for (const int k : sample)
          points.insert(points.end(), vesicles[k].begin(), vesicles[k].end());
        return points;
      },
      static_cast<int>(vesicles.size()));
}

std::optional<FittedLaw> fit_runs(const std::vector<History>& runs,
                                  const std::vector<double>& times,
                                  const statistics::Window& window) {
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
        statistics::Points points;
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

}  // namespace traceraft::observations
