// One run per folder.
#pragma once

#include <filesystem>
#include <stdexcept>

namespace traceraft::posix {

inline constexpr char kLockFile[] = ".lock";

struct LockedError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Holds an advisory lock on folder/.lock; the system releases it when the process ends, however it
// ends.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);  // throws LockedError, IoError
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace traceraft::posix
