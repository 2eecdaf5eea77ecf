// Registration of measured fields on a sphere: by which rotation a vesicle has turned between two
// snapshots.
#pragma once

#include <vector>

#include "kernel/fem/surface_space.hpp"
#include "kernel/geometry/level_set.hpp"

namespace traceraft::assimilation {

// A field on the unit sphere for fast looks at any direction: bilinear on the faces of a cube.
class SphereMap {
 public:
  // Throws InputError if the space is that of another surface.
  SphereMap(const fem::SurfaceSpace& space, const Vec& field);
  double at(const Point& x) const;

 private:
  static constexpr int kSide = 48;  // of a face
  Vec samples_;
};

struct Registration {
  Eigen::Matrix3d rotation;
  bool turned;         // is it any rotation?
  double correlation;  // of the values with the field turned by it
};

// The rotation Q that makes the values most like those of a field: v(x) ~ a + b f(Qᵀ x). Searched
// for over all rotations, then refined.
Eigen::Matrix3d most_alike_rotation(const SphereMap& field, const std::vector<Point>& points,
                                    const Vec& values);

// The same rotation. None if no rotation but a small one, which errors of the
// state allow for, makes them clearly more alike.
Registration register_values(const SphereMap& field, const std::vector<Point>& points,
                             const Vec& values);

// Is it the unit sphere around the origin?
bool is_sphere(const geometry::LevelSet& surface);

double angle_of(const Eigen::Matrix3d& rotation);

}  // namespace traceraft::assimilation
