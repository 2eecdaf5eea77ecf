#include "backends/posix/durable_file.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "kernel/core/error.hpp"

namespace traceraft::posix {
namespace {

[[noreturn]] void fail(const std::string& what, const std::filesystem::path& path) {
  throw IoError(what + " " + path.string() + ": " + std::strerror(errno));
}

class Descriptor {
 public:
  // `meant`: what messages name, where that is another file.
  Descriptor(const std::filesystem::path& path, int flags, std::filesystem::path meant = {})
      : path_(meant.empty() ? path : std::move(meant)) {
    // A pipe of that name is opened at once, and refused, instead of waiting for its other end.
    fd_ = ::open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK, 0644);
    if (fd_ < 0) fail("cannot open", path_);
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

// A name that nobody else has: 64 random bits.
std::filesystem::path temporary_beside(const std::filesystem::path& path) {
  std::uint64_t bits = 0;
  if (::getrandom(&bits, sizeof bits, 0) != sizeof bits) fail("cannot name a file beside", path);
  char name[40];
  std::snprintf(name, sizeof name, ".traceraft-%016llx.part",
                static_cast<unsigned long long>(bits));
  return path.parent_path() / name;
}

void refuse_special(int descriptor, const std::filesystem::path& path) {
  struct stat info {};
  if (::fstat(descriptor, &info) != 0) fail("cannot read", path);
  if (!S_ISREG(info.st_mode)) throw IoError("cannot write " + path.string() + ": not a file");
  if (info.st_nlink > 1)
    throw IoError("cannot write " + path.string() + ": the same file has another name, too");
}

}  // namespace

void write_durably(const std::filesystem::path& path, const std::string& content) {
  const std::filesystem::path temporary = temporary_beside(path);
  // Neither a file nor a link of that name is there, or this throws.
  Descriptor file(temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, path);
  try {
    write_all(file.get(), content, path);
    file.sync();
    file.close();
    if (::rename(temporary.c_str(), path.c_str()) != 0) fail("cannot write", path);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  Descriptor(folder, O_RDONLY | O_DIRECTORY).sync();
}

struct AppendFile::Handle : Descriptor {
  using Descriptor::Descriptor;
};

AppendFile::AppendFile(std::filesystem::path path, std::uint64_t size)
    : path_(std::move(path)),
      handle_(std::make_unique<Handle>(path_, O_WRONLY | O_CREAT | O_NOFOLLOW)),
      size_(size) {
  refuse_special(handle_->get(), path_);
  struct stat info {};
  if (::fstat(handle_->get(), &info) != 0) fail("cannot read", path_);
  if (static_cast<std::uint64_t>(info.st_size) < size)
    throw IoError(path_.string() + " has lost rows: it is shorter than the " +
                  std::to_string(size) + " bytes it had");
  if (::ftruncate(handle_->get(), static_cast<off_t>(size)) != 0 ||
      ::lseek(handle_->get(), 0, SEEK_END) < 0)
    fail("cannot cut", path_);
}

AppendFile::~AppendFile() = default;

void AppendFile::append(const std::string& record) {
  write_all(handle_->get(), record, path_);
  size_ += record.size();
}

void AppendFile::sync() {
  handle_->sync();
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

}  // namespace traceraft::posix
