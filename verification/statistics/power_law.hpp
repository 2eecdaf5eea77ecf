// Lines and power laws through measured points, and orders of convergence.
#pragma once

#include <utility>
#include <vector>

namespace traceraft::statistics {

using Points = std::vector<std::pair<double, double>>;

// A stretch of times, both ends included.
struct Window {
  double begin, end;
  bool contains(double t) const { return t >= begin && t <= end; }
};

struct Line {
  double slope, intercept;
};
// Least squares. At least two different x.
Line fit_line(const Points& points);
// ln y = slope · ln x + intercept. x, y > 0.
Line fit_power_law(const Points& points);

// y = c (t − t0)^b: the law of coarsening with an origin of its own, as L³ = L₀³ + K t has.
struct PowerLaw {
  double c, t0, b;
  double scatter;  // standard deviation of ln y about it
  double at(double t) const;
};
// t0 is at most that, over the first time: an origin may be seen later than the first points.
inline constexpr double kLatestOrigin = 1 - 1e-3;
// t0 is at least that, over the first time.
inline constexpr double kEarliestOrigin = -10;
// Least squares of ln y, t0 between kEarliestOrigin and `latest` times the first t. At least four
// points with t, y > 0.
PowerLaw fit_power_law_from(const Points& points, double latest = kLatestOrigin);
double first_time(const Points& points);

// The order p of errors e ~ h^p: between the two finest levels, and how much that differs from the
// order between the two before them (0 if there are no three).
struct ObservedOrder {
  double order, change;
};
ObservedOrder observed_order(const Points& size_and_error);

}  // namespace traceraft::statistics
