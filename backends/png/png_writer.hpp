// Images as PNG files (libpng).
#pragma once

#include <string>

#include "kernel/observables/surface_view.hpp"

namespace traceraft {

// The bytes of a PNG file. Throws std::runtime_error if libpng refuses.
std::string png_bytes(const Image& image);

}  // namespace traceraft
