// Surfaces that every ray from a centre meets once: like a sphere, they can be described by the
// directions of rays.
#pragma once

#include "kernel/geometry/level_set.hpp"

namespace traceraft::geometry {

class StarSurface {
 public:
  // Throws InputError, here or later, where a ray meets the surface never, more than once or
  // without crossing it.
  explicit StarSurface(LevelSetPtr level_set);

  // The centre of a unit sphere, wherever it is, or the origin.
  const Point& centre() const { return centre_; }
  bool is_unit_sphere() const { return unit_sphere_; }
  // Where the ray in a direction, a unit vector, meets the surface: the distance from the centre.
  double radius(const Point& direction) const;
  const LevelSet& level_set() const { return *level_set_; }

 private:
  double distance(const Point& from, const Point& direction) const;

  LevelSetPtr level_set_;
  Point centre_ = Point::Zero();
  bool unit_sphere_ = false;
};

}  // namespace traceraft::geometry
