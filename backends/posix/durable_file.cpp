#include "backends/posix/durable_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

[[noreturn]] void fail(const std::string& what, const std::filesystem::path& path) {
  throw IoError(what + " " + path.string() + ": " + std::strerror(errno));
}

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags) : path_(path) {
    fd_ = ::open(path.c_str(), flags | O_CLOEXEC, 0644);
    if (fd_ < 0) fail("cannot open", path);
  }
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return fd_; }
  void sync() {
    if (::fsync(fd_) != 0) fail("cannot write", path_);
  }
  void close() {
    const int fd = fd_;
    fd_ = -1;
    if (::close(fd) != 0) fail("cannot write", path_);
  }

 private:
  std::filesystem::path path_;
  int fd_;
};

void write_all(int descriptor, const std::string& data, const std::filesystem::path& path) {
  std::size_t done = 0;
  while (done < data.size()) {
    const ssize_t count = ::write(descriptor, data.data() + done, data.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("cannot write", path);
    done += static_cast<std::size_t>(count);
  }
}

}  // namespace

void write_durably(const std::filesystem::path& path, const std::string& content) {
  std::filesystem::path temporary = path;
  temporary += ".part";
  try {
    Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    write_all(file.get(), content, temporary);
    file.sync();
    file.close();
    if (::rename(temporary.c_str(), path.c_str()) != 0) fail("cannot rename", temporary);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  Descriptor(folder, O_RDONLY | O_DIRECTORY).sync();
}

AppendFile::AppendFile(std::filesystem::path path, std::uint64_t size)
    : path_(std::move(path)), size_(size) {
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail("cannot open", path_);
  struct stat info {};
  if (::fstat(descriptor_, &info) != 0 || static_cast<std::uint64_t>(info.st_size) < size) {
    ::close(descriptor_);
    throw IoError(path_.string() + " has lost rows: it is shorter than the " +
                  std::to_string(size) + " bytes it had");
  }
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0 ||
      ::lseek(descriptor_, 0, SEEK_END) < 0) {
    ::close(descriptor_);
    fail("cannot cut", path_);
  }
}

AppendFile::~AppendFile() {
  ::close(descriptor_);
}

void AppendFile::append(const std::string& record) {
  write_all(descriptor_, record, path_);
  size_ += record.size();
}

void AppendFile::sync() {
  if (::fsync(descriptor_) != 0) fail("cannot write", path_);
}

std::string read_file(const std::filesystem::path& path, std::uint64_t limit) {
  Descriptor file(path, O_RDONLY);
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) fail("cannot read", path);
  if (!S_ISREG(info.st_mode)) throw IoError("cannot read " + path.string() + ": not a file");
  if (static_cast<std::uint64_t>(info.st_size) > limit)
    throw IoError("cannot read " + path.string() + ": it has " + std::to_string(info.st_size) +
                  " bytes, more than the " + std::to_string(limit) + " allowed");
  std::string content(static_cast<std::size_t>(info.st_size), '\0');
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t count = ::read(file.get(), content.data() + done, content.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("cannot read", path);
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  content.resize(done);
  return content;
}

}  // namespace traceraft
