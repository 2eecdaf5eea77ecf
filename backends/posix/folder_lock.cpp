#include "backends/posix/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "kernel/core/error.hpp"

namespace traceraft::posix {

FolderLock::FolderLock(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kLockFile;
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (descriptor_ < 0) throw IoError("cannot open " + path.string() + ": " + std::strerror(errno));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const int error = errno;
  ::close(descriptor_);
  if (error == EWOULDBLOCK)
    throw LockedError("another process is using " + folder.string() +
                      "; wait until it ends, or choose another folder");
  throw IoError("cannot lock " + path.string() + ": " + std::strerror(error));
}

FolderLock::~FolderLock() {
  ::close(descriptor_);
}

}  // namespace traceraft::posix
