#include "kernel/fem/trace.hpp"

namespace traceraft::fem {

Vec trace(const SurfaceSpace& space, VecView nodal) {
  const std::vector<mesh::CutPoint>& points = space.surface.points;
  Vec values(points.size());
  space.team->for_range(points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) values[p] = points[p].trace(nodal);
  });
  return values;
}

void add_trace_transpose(const SurfaceSpace& space, double factor, const Vec& load, VecRef r) {
  space.team->run([&](int part) {
    const RowBlock& block = space.blocks[part];
    for (int p = block.touching_points.begin; p < block.touching_points.end; ++p) {
      const auto& [low, high, s] = space.surface.points[p];
      if (block.rows.contains(low)) r[low] += factor * (1 - s) * load[p];
      if (block.rows.contains(high)) r[high] += factor * s * load[p];
    }
  });
}

}  // namespace traceraft::fem
