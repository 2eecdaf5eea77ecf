// Text from printf formats.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace traceraft {

// At most 511 characters: a line for people.
template <class... Values>
std::string formatted(const char* format, Values... values) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

inline std::string joined(const std::vector<std::string>& parts, const char* between) {
  std::string text;
  for (const std::string& part : parts) text += (&part == &parts.front() ? "" : between) + part;
  return text;
}

}  // namespace traceraft
