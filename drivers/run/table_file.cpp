#include "drivers/run/table_file.hpp"

#include <string_view>

#include "backends/zlib/checksum.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::run {
namespace {

constexpr std::uint64_t kLargestTable = std::uint64_t{1} << 36;

// The extent as it was checked, so that nothing is cut off before that.
std::uint64_t checked_size(const std::filesystem::path& path, const TableExtent& extent) {
  if (extent.bytes > 0 && std::filesystem::exists(path)) require_extent(path, extent);
  return extent.bytes;
}

}  // namespace

void require_extent(const std::filesystem::path& path, const TableExtent& extent) {
  const std::string text = posix::read_file(path, kLargestTable);
  if (text.size() < extent.bytes)
    throw DamagedFile(path.string() + " has lost rows: it should have " +
                      std::to_string(extent.bytes) + " bytes");
  const std::string_view counted = std::string_view(text).substr(0, extent.bytes);
  if (zlib::crc32_of(counted) != extent.checksum)
    throw DamagedFile(
        path.string() +
        " is damaged: its rows have changed; restore it, or start again in another folder");
}

TableExtent extent_of_file(const std::filesystem::path& path) {
  const std::string text = posix::read_file(path, kLargestTable);
  return {text.size(), zlib::crc32_of(text)};
}

TableFile::TableFile(const std::filesystem::path& path, const TableExtent& extent)
    : file_(path, checked_size(path, extent)), checksum_(extent.checksum) {}

void TableFile::append(const std::string& rows) {
  file_.append(rows);
  checksum_ = zlib::crc32_of(rows, checksum_);
}

}  // namespace traceraft::run
