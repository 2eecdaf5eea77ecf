// Fields on surfaces from the files that vtu_writer.hpp describes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kernel/core/types.hpp"
#include "kernel/observables/surface_view.hpp"

namespace traceraft::zlib {

struct SurfaceField {
  observables::SurfaceMesh mesh;
  Vec values;
};

// The field of that name and its mesh. Throws IoError unless the text is such a file.
SurfaceField read_vtu(const std::string& text, const std::string& field);

// Whole numbers of the triangles, in their order. Throws IoError unless they are there.
std::vector<int> read_cells(const std::string& text, const std::string& field);

// The names of the pieces of a .pvtu file, and (time, file) of a .pvd collection.
std::vector<std::string> pieces_of_pvtu(const std::string& text);
std::vector<std::pair<double, std::string>> files_of_pvd(const std::string& text);

}  // namespace traceraft::zlib
