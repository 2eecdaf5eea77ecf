// Text in UTF-8 (RFC 3629), code point by code point.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace traceraft::text {

struct CodePoint {
  char32_t value;    // the byte itself if it begins no valid sequence
  std::size_t size;  // in bytes, at least 1
  bool valid;
};

// `text` must not be empty.
CodePoint first_code_point(std::string_view text);

bool is_utf8(std::string_view text);

// C0 and C1 controls and DEL.
bool is_control(char32_t point);

}  // namespace traceraft::text
