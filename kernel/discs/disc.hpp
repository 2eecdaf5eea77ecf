// A raft as a disc on the unit sphere: a cap with a sharp boundary.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernel/core/types.hpp"

namespace traceraft::discs {

// Lengths are in R, areas in R².
struct Disc {
  Point centre;  // a unit vector
  double area;   // between 0 and 4π
};

inline double cosine_of_half_angle(double area) {
  return std::clamp(1 - area / (2 * kPi), -1.0, 1.0);
}
inline double half_angle(double area) {
  return 2 * std::asin(std::sqrt(std::clamp(area / (4 * kPi), 0.0, 1.0)));
}
inline double sine_of_half_angle(double area) {
  return std::sqrt(std::max(0.0, area / (2 * kPi) * (2 - area / (2 * kPi))));
}
inline double perimeter(double area) {
  return 2 * kPi * sine_of_half_angle(area);
}
// The geodesic curvature of the boundary, cot α.
inline double curvature(double area) {
  return cosine_of_half_angle(area) / sine_of_half_angle(area);
}
inline double area_of_half_angle(double angle) {
  const double half = std::sin(0.5 * angle);
  return 4 * kPi * half * half;
}

inline double angle_between(const Point& x, const Point& y) {
  return std::atan2(x.cross(y).norm(), x.dot(y));
}
// The distance of two boundaries along the sphere; negative where discs overlap.
inline double gap(const Disc& x, const Disc& y) {
  return angle_between(x.centre, y.centre) - half_angle(x.area) - half_angle(y.area);
}
// The gap is at least this, which needs no angle: chords are shorter than arcs, and π √(area/4π) is
// longer than a half angle.
inline double least_gap(const Disc& x, const Disc& y) {
  const double radii = 0.5 * std::sqrt(kPi) * (std::sqrt(x.area) + std::sqrt(y.area));
  return (x.centre - y.centre).norm() - radii;
}

// Two unit vectors, as columns, in the tangent plane of a point.
using TangentFrame = Eigen::Matrix<double, 3, 2>;
inline TangentFrame tangent_frame(const Point& x) {
  Eigen::Index smallest = 0;
  x.cwiseAbs().minCoeff(&smallest);
  TangentFrame frame;
  frame.col(0) = x.cross(Point(Point::Unit(smallest))).normalized();
  frame.col(1) = x.cross(Point(frame.col(0)));
  return frame;
}

}  // namespace traceraft::discs
