#include "verification/bench/work_precision.hpp"

#include <algorithm>
#include <limits>

#include "kernel/core/text.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::bench {
namespace {

std::map<std::string, std::vector<int>> by_method(const std::vector<WorkPoint>& points) {
  std::map<std::string, std::vector<int>> methods;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<int>& own = methods[points[i].method()];
    if (points[i].ok()) own.push_back(static_cast<int>(i));
  }
  return methods;
}

// The smallest error that every method with a result has reached.
double common_error(const std::vector<WorkPoint>& points) {
  double common = 0;
  for (const auto& [name, own] : by_method(points)) {
    double best = std::numeric_limits<double>::infinity();
    for (const int i : own) best = std::min(best, points[i].error);
    if (!own.empty()) common = std::max(common, best);
  }
  return common;
}

std::string describe(const WorkPoint& p) {
  return formatted("%s at tolerance %g", p.method().c_str(), p.tolerance);
}

std::string sentence(const std::vector<WorkPoint>& points, const Recommendation& advice) {
  if (advice.cheapest.empty())
    return any_result(points)
               ? formatted("No method reached an error of %.1e. Choose smaller --tolerances.",
                           advice.target)
               : std::string("No combination has a result.");
  const WorkPoint& best = points[advice.cheapest[0]];
  const statistics::Sample wall = statistics::sample_of(best.wall_s);
  std::string advised = formatted(
      "For an error of %.1e at the end, use %s: %.3g s wall time, %.3g s CPU", advice.target,
      describe(best).c_str(), wall.median, statistics::sample_of(best.cpu_s).median);
  if (advice.cheapest.size() > 1) {
    const WorkPoint& next = points[advice.cheapest[1]];
    const statistics::Sample other = statistics::sample_of(next.wall_s);
    advised +=
        other.min <= wall.max
            ? formatted("; %s is as fast within the spread of the times", describe(next).c_str())
            : formatted("; the next method, %s, takes %.1f times as long", describe(next).c_str(),
                        other.median / wall.median);
  }
  if (!advice.missed.empty())
    advised += "; this error was not reached by " + joined(advice.missed, ", ");
  return advised + ".";
}

}  // namespace

bool any_result(const std::vector<WorkPoint>& points) {
  return std::any_of(points.begin(), points.end(),
                     [](const WorkPoint& point) { return point.ok(); });
}

Recommendation recommend(const std::vector<WorkPoint>& points, double target_error) {
  Recommendation advice;
  advice.target = target_error > 0 ? target_error : common_error(points);
  const auto wall = [&](int i) { return statistics::sample_of(points[i].wall_s).median; };
  for (const auto& [name, own] : by_method(points)) {
    int cheapest = -1;
    for (const int i : own)
      if (points[i].error <= advice.target && (cheapest < 0 || wall(i) < wall(cheapest)))
        cheapest = i;
    if (cheapest < 0)
      advice.missed.push_back(name);
    else
      advice.cheapest.push_back(cheapest);
  }
  std::sort(advice.cheapest.begin(), advice.cheapest.end(),
            [&](int a, int b) { return wall(a) < wall(b); });
  advice.sentence = sentence(points, advice);
  return advice;
}

}  // namespace traceraft::bench
