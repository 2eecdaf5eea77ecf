// Text in CSV files (RFC 4180).
#pragma once

#include <string>

#include "backends/zlib/checksum.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::text {

// A remark after the last row, by which damage to the table is noticed.
inline constexpr char kChecksumRemark[] = "# CRC-32 of the rows above: ";
inline std::string checksum_line(const std::string& table) {
  return kChecksumRemark + formatted("%08x", zlib::crc32_of(table)) + "\n";
}

inline std::string csv_quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char ch : text) quoted += ch == '"' ? "\"\"" : std::string(1, ch);
  return quoted + "\"";
}

// In quotes where it has to be.
inline std::string csv_cell(const std::string& text) {
  return text.find_first_of(",\"\n") == std::string::npos ? text : csv_quoted(text);
}

}  // namespace traceraft::text
