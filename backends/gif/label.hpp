// Words in pictures (the font of giflib).
#pragma once

#include <string>

#include "kernel/observables/surface_view.hpp"

namespace traceraft {

// Writes ASCII text, dark, in the middle of the bottom; letters are a thirtieth of the height, 8
// pixels at least. What is wider than the image is cut off.
void write_label(Image& image, const std::string& text);

}  // namespace traceraft
