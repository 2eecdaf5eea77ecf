#include "backends/gif/label.hpp"

#include <gif_lib.h>

#include <algorithm>

namespace traceraft::gif {
namespace {

constexpr int kLettersPerHeight = 30, kAscii = 128;
constexpr int kTextDot = kTextHeight / GIF_FONT_HEIGHT;

void write(observables::Image& image, int left, int top, int dot, const std::string& text) {
  for (const char ch : text) {
    const auto code = static_cast<unsigned char>(ch);
    for (int row = 0; code < kAscii && row < GIF_FONT_HEIGHT; ++row)
      for (int column = 0; column < GIF_FONT_WIDTH; ++column)
        if (GifAsciiTable8x8[code][row] & (1 << (GIF_FONT_WIDTH - 1 - column)))
          observables::fill(image, left + column * dot, top + row * dot, dot, dot,
                            observables::kInk);
    left += dot * GIF_FONT_WIDTH;
  }
}

}  // namespace

void write_label(observables::Image& image, const std::string& text) {
  const int dot = std::max(1, image.height / (kLettersPerHeight * GIF_FONT_HEIGHT));
  const int top = image.height - dot * (GIF_FONT_HEIGHT + GIF_FONT_HEIGHT / 2);
  write(image, (image.width - dot * text_width(text) / kTextDot) / 2, top, dot, text);
}

void write_text(observables::Image& image, int left, int top, const std::string& text) {
  write(image, left, top, kTextDot, text);
}

int text_width(const std::string& text) {
  return kTextDot * GIF_FONT_WIDTH * static_cast<int>(text.size());
}

}  // namespace traceraft::gif
