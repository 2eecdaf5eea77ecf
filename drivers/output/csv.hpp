// Text in CSV files (RFC 4180).
#pragma once

#include <string>

namespace traceraft {

inline std::string csv_quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char ch : text) quoted += ch == '"' ? "\"\"" : std::string(1, ch);
  return quoted + "\"";
}

// In quotes where it has to be.
inline std::string csv_cell(const std::string& text) {
  return text.find_first_of(",\"\n") == std::string::npos ? text : csv_quoted(text);
}

}  // namespace traceraft
