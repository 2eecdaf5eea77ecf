// A view of a surface that readers of a page turn and move through time.
#pragma once

#include <string>
#include <vector>

#include "drivers/output/page.hpp"
#include "drivers/report/surface_frames.hpp"

namespace traceraft::report {

struct View {
  std::vector<std::string> labels;  // of the frames
  double low, high;                 // values are shown between them, to 1/255
  std::size_t first = 0;            // shown before anything is chosen
  bool differences = false;         // from their middle: what is near it is a veil
};

// Adds the view with all its data and scripts, three.js among them (Debian package libjs-three).
// Returns "", or why there is no view.
std::string add_viewer(output::Page& page, const std::vector<observables::SurfaceMesh>& meshes,
                       const std::vector<Frame>& frames, const View& view);

}  // namespace traceraft::report
