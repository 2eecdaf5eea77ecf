#include "drivers/text/utf8.hpp"

namespace traceraft::text {
namespace {

struct Lead {
  std::size_t size;    // 0: no byte that begins a sequence
  unsigned char bits;  // of the code point that the first byte holds
  char32_t least;      // smaller ones have a shorter sequence
};

Lead lead_of(unsigned char byte) {
  if (byte < 0x80) return {1, byte, 0};
  if ((byte & 0xE0) == 0xC0) return {2, static_cast<unsigned char>(byte & 0x1F), 0x80};
  if ((byte & 0xF0) == 0xE0) return {3, static_cast<unsigned char>(byte & 0x0F), 0x800};
  if ((byte & 0xF8) == 0xF0) return {4, static_cast<unsigned char>(byte & 0x07), 0x10000};
  return {0, byte, 0};
}

}  // namespace

CodePoint first_code_point(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const CodePoint invalid{byte(0), 1, false};
  const Lead lead = lead_of(byte(0));
  if (lead.size == 0 || lead.size > text.size()) return invalid;
  char32_t value = lead.bits;
  for (std::size_t k = 1; k < lead.size; ++k) {
    if ((byte(k) & 0xC0) != 0x80) return invalid;
    value = (value << 6) | (byte(k) & 0x3Fu);
  }
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (value < lead.least || surrogate || value > 0x10FFFF) return invalid;
  return {value, lead.size, true};
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const CodePoint point = first_code_point(text);
    if (!point.valid) return false;
    text.remove_prefix(point.size);
  }
  return true;
}

bool is_control(char32_t point) {
  return point < 0x20 || (point >= 0x7F && point <= 0x9F);
}

}  // namespace traceraft::text
