#include "backends/posix/durable_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "backends/posix/folder_lock.hpp"
#include "kernel/core/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::TemporaryFolder;

// Files cannot grow beyond `bytes` while this lives: what a full disk looks like to a writer.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit small = before_;
    small.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST(DurableFile, ReplacesTheWholeContent) {
  const TemporaryFolder folder;
  posix::write_durably(folder.path / "a", "first");
  posix::write_durably(folder.path / "a", "second, longer");
  EXPECT_EQ(posix::read_file(folder.path / "a", 100), "second, longer");
  EXPECT_EQ(folder.entries(), 1u) << "a temporary file was left";
  EXPECT_THROW(posix::read_file(folder.path / "a", 3), IoError);
  EXPECT_THROW(posix::read_file(folder.path / "b", 100), IoError);
  EXPECT_THROW(posix::write_durably(folder.path / "missing" / "a", "x"), IoError);
}

TEST(DurableFile, KeepsTheOldContentWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  posix::write_durably(folder.path / "a", "old");
  {
    const SmallDisk disk(1000);
    EXPECT_THROW(posix::write_durably(folder.path / "a", std::string(5000, 'x')), IoError);
  }
  EXPECT_EQ(posix::read_file(folder.path / "a", 100), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(AppendFile, GrowsByRecordsAndIsCutToASize) {
  const TemporaryFolder folder;
  {
    posix::AppendFile file(folder.path / "t", 0);
    file.append("one\n");
    file.append("two\n");
    EXPECT_EQ(file.size(), 8u);
  }
  posix::AppendFile file(folder.path / "t", 4);
  file.append("three\n");
  file.sync();
  EXPECT_EQ(posix::read_file(folder.path / "t", 100), "one\nthree\n");
  EXPECT_THROW(posix::AppendFile(folder.path / "t", 1000), IoError) << "a lost row went unnoticed";
  const SmallDisk disk(12);
  EXPECT_THROW(file.append("four\n"), IoError);
}

TEST(FolderLock, IsHeldByOne) {
  const TemporaryFolder folder;
  {
    const posix::FolderLock lock(folder.path);
    EXPECT_THROW(posix::FolderLock again(folder.path), posix::LockedError);
  }
  EXPECT_NO_THROW(posix::FolderLock later(folder.path));
  EXPECT_THROW(posix::FolderLock none(folder.path / "missing"), IoError);
}

// A link of the name of a file is replaced, what it points to is left alone.
TEST(DurableFile, WritesThroughNoLink) {
  const TemporaryFolder folder, outside;
  posix::write_durably(outside.path / "victim", "of somebody");
  std::filesystem::create_symlink(outside.path / "victim", folder.path / "a");
  std::filesystem::create_symlink(outside.path / "victim", folder.path / "a.part");
  posix::write_durably(folder.path / "a", "content");
  EXPECT_EQ(posix::read_file(outside.path / "victim", 100), "of somebody");
  EXPECT_FALSE(std::filesystem::is_symlink(folder.path / "a"));
  EXPECT_EQ(posix::read_file(folder.path / "a", 100), "content");
}

TEST(AppendFile, OpensNoLinkAndNoFileOfTwoNames) {
  const TemporaryFolder folder, outside;
  posix::write_durably(outside.path / "victim", "of somebody");
  std::filesystem::create_symlink(outside.path / "victim", folder.path / "link");
  std::filesystem::create_symlink(outside.path / "new", folder.path / "dangling");
  std::filesystem::create_hard_link(outside.path / "victim", folder.path / "twin");
  for (const char* name : {"link", "dangling", "twin"})
    EXPECT_THROW(posix::AppendFile(folder.path / name, 0), IoError) << name;
  EXPECT_EQ(posix::read_file(outside.path / "victim", 100), "of somebody");
  EXPECT_FALSE(std::filesystem::exists(outside.path / "new"));
}

TEST(FolderLock, FollowsNoLink) {
  const TemporaryFolder folder, outside;
  std::filesystem::create_symlink(outside.path / "new", folder.path / posix::kLockFile);
  EXPECT_THROW(posix::FolderLock lock(folder.path), IoError);
  EXPECT_EQ(outside.entries(), 0u);
}

}  // namespace
}  // namespace traceraft
