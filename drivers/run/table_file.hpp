// Tables that grow row by row, and are known by a checksum of their rows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "backends/posix/durable_file.hpp"

namespace traceraft::run {

struct TableExtent {
  std::uint64_t bytes = 0;
  std::uint32_t checksum = 0;  // CRC-32 of them

  bool operator==(const TableExtent& other) const {
    return bytes == other.bytes && checksum == other.checksum;
  }
};
using TableExtents = std::map<std::string, TableExtent>;  // by the names of the files

class TableFile {
 public:
  // Opens or creates `path` and cuts it to `extent`. Throws IoError if it is shorter, DamagedFile,
  // with the file as it was, if its rows are others than those that were counted.
  TableFile(const std::filesystem::path& path, const TableExtent& extent);

  void append(const std::string& rows);  // throws IoError
  void sync() { file_.sync(); }          // throws IoError
  TableExtent extent() const { return {file_.size(), checksum_}; }

 private:
  posix::AppendFile file_;
  std::uint32_t checksum_;
};

TableExtent extent_of_file(const std::filesystem::path& path);  // throws IoError

// Throws DamagedFile unless the file begins with these bytes, IoError if it cannot be read.
void require_extent(const std::filesystem::path& path, const TableExtent& extent);

}  // namespace traceraft::run
