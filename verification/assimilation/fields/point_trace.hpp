// Values of fields at points near Γ_h: places of measurement, and the nodes of another mesh.
#pragma once

#include <Eigen/Sparse>
#include <vector>

#include "kernel/fem/surface_space.hpp"
#include "kernel/mesh/nearest_triangle.hpp"

namespace traceraft::assimilation {

// A row per point, a column per node: values = trace · nodal. Serial spaces only.
using PointTrace = Eigen::SparseMatrix<double, Eigen::RowMajor>;

PointTrace trace_at(const fem::SurfaceSpace& space, const std::vector<mesh::SurfacePlace>& places);

// A field at a point is c_h at the point of Γ_h nearest to it. Throws InputError naming the first
// point that is further than `reach` away.
PointTrace point_trace(const fem::SurfaceSpace& space, const std::vector<Point>& points,
                       double reach);

}  // namespace traceraft::assimilation
