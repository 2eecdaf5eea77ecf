#include "kernel/geometry/star_surface.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/error.hpp"

namespace traceraft::geometry {
namespace {

constexpr int kSamples = 96;     // along a ray
constexpr double kRound = 1e-9;  // off a sphere

[[noreturn]] void refuse(const Point& direction, const char* how) {
  throw InputError("of this one a ray from the centre in the direction (" +
                   format_number(direction[0]) + ", " + format_number(direction[1]) + ", " +
                   format_number(direction[2]) + ") " + how);
}

}  // namespace

StarSurface::StarSurface(LevelSetPtr level_set) : level_set_(std::move(level_set)) {
  Point middle;  // of the chords along the axes, which a sphere's centre is
  for (int i = 0; i < 3; ++i)
    middle[i] =
        0.5 * (distance(Point::Zero(), Point::Unit(i)) - distance(Point::Zero(), -Point::Unit(i)));
  unit_sphere_ = true;
  for (int k = 0; k < 50 && unit_sphere_; ++k) {
    const Point direction(std::sin(1 + k), std::sin(2 + 3 * k), std::sin(5 + 7 * k));
    unit_sphere_ = std::fabs(level_set_->value(middle + direction.normalized())) < kRound;
  }
  if (unit_sphere_) centre_ = middle;
}

double StarSurface::radius(const Point& direction) const {
  return distance(centre_, direction);
}

// The sign changes once along a ray; there, bisection and the secant's steps in turn.
double StarSurface::distance(const Point& from, const Point& direction) const {
  const auto phi = [&](double r) { return level_set_->value(from + r * direction); };
  if (!(phi(0) < 0)) throw InputError("the origin lies outside this surface");
  const double longest = (kBoxHalfWidth - from.lpNorm<Eigen::Infinity>()) /
                         direction.lpNorm<Eigen::Infinity>();  // within the box
  double low = 0, high = 0;
  for (int k = 1; k <= kSamples; ++k) {
    const double r = longest * k / kSamples;
    const bool outside = !(phi(r) < 0), was_outside = high > 0;
    if (outside == was_outside) continue;
    if (was_outside) refuse(direction, "meets the surface more than once");
    low = longest * (k - 1) / kSamples;
    high = r;
  }
  if (high == 0) refuse(direction, "does not meet the surface");
  double at_low = phi(low), at_high = phi(high);
  for (int k = 0; k < 100 && high - low > 1e-15; ++k) {
    const double secant = high - at_high * (high - low) / (at_high - at_low);
    const double r = k % 2 == 0 && secant > low && secant < high ? secant : 0.5 * (low + high);
    const double value = phi(r);
    if (value == 0) return r;
    (value < 0 ? low : high) = r;
    (value < 0 ? at_low : at_high) = value;
  }
  return 0.5 * (low + high);
}

}  // namespace traceraft::geometry
