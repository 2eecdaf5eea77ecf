// Words in pictures (the font of giflib).
#pragma once

#include <string>

#include "kernel/observables/surface_view.hpp"

namespace traceraft::gif {

// Writes ASCII text, dark, in the middle of the bottom; letters are a thirtieth of the height, 8
// pixels at least. What is wider than the image is cut off.
void write_label(observables::Image& image, const std::string& text);

// Writes ASCII text from that corner on, in letters of 16 pixels.
inline constexpr int kTextHeight = 16;
void write_text(observables::Image& image, int left, int top, const std::string& text);
int text_width(const std::string& text);

}  // namespace traceraft::gif
