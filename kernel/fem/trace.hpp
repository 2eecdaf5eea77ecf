// Between nodal fields and their traces on Γ_h: with P the values of the basis functions at the
// points of the cut surface, c|Γ = P c and every load vector is Pᵀ of loads at the points.
#pragma once

#include <array>

#include "kernel/fem/surface_space.hpp"

namespace traceraft::fem {

// P c. `nodal` has ghosts.
Vec trace(const SurfaceSpace& space, VecView nodal);

// r += factor · Pᵀ load.
void add_trace_transpose(const SurfaceSpace& space, double factor, const Vec& load, VecRef r);

// Sums local(triangle number), three loads at the triangle's corners, over all triangles.
template <class Local>
Vec point_loads(const SurfaceSpace& space, const Local& local) {
  Vec load = Vec::Zero(static_cast<Eigen::Index>(space.surface.points.size()));
  space.team->run([&](int part) {
    const RowBlock& block = space.blocks[part];
    for (int t = block.touching_triangles.begin; t < block.touching_triangles.end; ++t) {
      const std::array<double, 3> value = local(t);
      for (int k = 0; k < 3; ++k) {
        const int point = space.surface.triangles[t][k];
        if (block.points.contains(point)) load[point] += value[k];
      }
    }
  });
  return load;
}

}  // namespace traceraft::fem
