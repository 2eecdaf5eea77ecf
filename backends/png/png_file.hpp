// Images as PNG files (libpng).
#pragma once

#include <string>

#include "kernel/observables/surface_view.hpp"

namespace traceraft::png {

// The bytes of a PNG file. Throws std::runtime_error if libpng refuses.
std::string png_bytes(const observables::Image& image);

// The image of such a file. Throws std::runtime_error if it is none, or larger than 2^13 pixels
// along an edge.
observables::Image image_of_png(const std::string& bytes);

}  // namespace traceraft::png
