// Text from printf formats.
#pragma once

#include <cstdio>
#include <string>

namespace traceraft {

// At most 511 characters: a line for people.
template <class... Values>
std::string formatted(const char* format, Values... values) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

}  // namespace traceraft
