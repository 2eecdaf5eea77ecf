// How much the mean curvature of a surface varies.
#pragma once

#include <vector>

#include "kernel/geometry/level_set.hpp"

namespace traceraft::assimilation {

// The difference of its largest and its least value over the largest absolute one, at places near
// the surface; 0 for a sphere. Level sets have to be twice differentiable there.
double curvature_contrast(const geometry::LevelSet& surface, const std::vector<Point>& places);

}  // namespace traceraft::assimilation
