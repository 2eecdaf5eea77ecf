// A view of a surface that readers of a page turn and move through time.
#pragma once

#include <string>

#include "drivers/output/page.hpp"
#include "drivers/report/surface_frames.hpp"

namespace traceraft {

// Adds the view with all its data and scripts, three.js among them (Debian package libjs-three).
// Values are shown between `low` and `high`, to 1/255. Returns "", or why there is no view.
std::string add_viewer(Page& page, const SurfaceFrames& frames, double low, double high,
                       const std::string& time_unit);

}  // namespace traceraft
