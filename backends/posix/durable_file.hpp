// Files that are whole or absent, through the POSIX system interface.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace traceraft::posix {

// Temporary files have this name with 16 hexadecimal digits for the question marks. A process that
// is killed may leave one.
inline constexpr char kTemporaryFiles[] = ".traceraft-????????????????.part";

// Writes `content` to a temporary name beside `path`, syncs it, renames it and syncs the folder: at
// any moment, power failure included, `path` holds either the old or the new content. A link of
// that name is replaced, never followed. Throws IoError, with the old content intact, when the disk
// is full or anything else fails.
void write_durably(const std::filesystem::path& path, const std::string& content);

// A file that only grows by whole records, e.g. a table.
class AppendFile {
 public:
  // Opens or creates `path` and cuts it to `size` bytes. Throws IoError, also if it is shorter, a
  // link, or a file that has another name, too.
  AppendFile(std::filesystem::path path, std::uint64_t size);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  void append(const std::string& record);  // reaches the file system at once; throws IoError
  void sync();                             // reaches the disk; throws IoError
  std::uint64_t size() const { return size_; }

 private:
  struct Handle;
  std::filesystem::path path_;
  std::unique_ptr<Handle> handle_;
  std::uint64_t size_;
};

// The whole content of a file. Throws IoError if it cannot be read or exceeds `limit` bytes.
std::string read_file(const std::filesystem::path& path, std::uint64_t limit);

}  // namespace traceraft::posix
