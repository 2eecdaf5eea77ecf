#include "drivers/data/law_report.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/text.hpp"

namespace traceraft::data {

const output::Row& law_heading() {
  static const output::Row row = {
      "perimeter / radius = c (t - t0)^b", "b (95 %)", "t0 (s)", "c", "scatter of ln", "points"};
  return row;
}

output::Row law_row(const std::string& of, const std::optional<observations::FittedLaw>& law) {
  if (!law) return {of, "too few points in the --window", "", "", "", ""};
  const auto with = [](double value, const statistics::Interval& interval) {
    return formatted("%.3g (%.3g to %.3g)", value, interval.low, interval.high);
  };
  return {of,
          with(law->law.b, law->b),
          law->t0_open ? formatted("%.3g (to %.3g)", law->law.t0, law->t0.high)
                       : with(law->law.t0, law->t0),
          with(law->law.c, law->c),
          formatted("%.2f", law->law.scatter),
          std::to_string(law->points)};
}

output::Row law_row(const observations::PublishedFacts& facts) {
  const statistics::PowerLaw& law = facts.perimeter;
  return {formatted("published, %g to %g s", facts.window.begin, facts.window.end),
          formatted("%.3g", law.b),
          formatted("%.3g", law.t0),
          formatted("%.3g", law.c),
          formatted("%.2f (assumed)", law.scatter),
          std::to_string(facts.measurements)};
}

std::vector<std::string> remarks_on(
    std::initializer_list<std::optional<observations::FittedLaw>> laws) {
  for (const std::optional<observations::FittedLaw>& law : laws)
    if (law && law->t0_open)
      return {
          "An interval of t0 without a lower end means that t0 may be earlier than the search "
          "allows (minus ten times the first time). Then b may be lower, and c larger, than their "
          "intervals say."};
  return {};
}

bench::ChartSeries law_curve(const std::string& name, const statistics::PowerLaw& law,
                             const statistics::Window& window) {
  bench::ChartSeries series{name, {}, bench::Mark::line};
  constexpr int kPoints = 40;
  for (int i = 0; i <= kPoints; ++i) {
    const double t = std::max(window.begin, 1e-3) *
                     std::pow(window.end / std::max(window.begin, 1e-3), i * 1.0 / kPoints);
    if (t > law.t0) series.points.emplace_back(t, law.at(t));
  }
  return series;
}

}  // namespace traceraft::data
