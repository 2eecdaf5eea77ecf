// Fields on Γ_h for ParaView: VTK XML files with zlib-compressed data.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kernel/core/types.hpp"
#include "kernel/fem/surface_space.hpp"

namespace traceraft::zlib {

struct PointField {
  std::string name;
  Vec values;  // one per point of the surface
};

struct CellField {
  std::string name;
  std::vector<int> values;  // one per triangle of the surface
};

// The text of an UnstructuredGrid (.vtu) file: the triangles of Γ_h that count on this rank,
// coordinates times `length`. 32-bit floats, which is what pictures need; tables keep full
// precision.
std::string vtu_text(const fem::SurfaceSpace& space, double length,
                     const std::vector<PointField>& fields,
                     const std::vector<CellField>& cell_fields = {});

// The text of a file (.pvtu) that joins the pieces of all ranks: their names relative to it.
std::string pvtu_text(const std::vector<std::string>& pieces,
                      const std::vector<std::string>& fields,
                      const std::vector<std::string>& cell_fields = {});

// The text of a collection (.pvd): (time, file name relative to the collection).
std::string pvd_text(const std::vector<std::pair<double, std::string>>& files);

}  // namespace traceraft::zlib
