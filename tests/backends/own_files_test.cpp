#include "backends/posix/own_files.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "backends/posix/durable_file.hpp"
#include "kernel/core/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

class OwnFilesTest : public ::testing::Test {
 protected:
  testing::TemporaryFolder outside;
  const fs::path folder = outside.path / "run";
  const std::vector<std::string> names = {"table.csv", "fields/field-????.vtu"};

  void SetUp() override {
    fs::create_directories(folder / "fields");
    std::ofstream(folder / "table.csv") << "rows";
    std::ofstream(folder / "fields/field-0001.vtu") << "field";
    std::ofstream(outside.path / "victim") << "of somebody";
  }
};

TEST_F(OwnFilesTest, AreDeletedWithTheirFolder) {
  std::ofstream(folder / ".traceraft-0123456789abcdef.part") << "left by a killed process";
  std::ofstream(folder / "fields/.traceraft-0123456789abcdef.part") << "and there";
  EXPECT_EQ(posix::first_foreign(folder, names), "");
  posix::remove_own_folder(folder, names);
  EXPECT_FALSE(fs::exists(folder));
  EXPECT_TRUE(fs::exists(outside.path / "victim"));
}

TEST_F(OwnFilesTest, KeepEverythingBesideAForeignFile) {
  for (const char* foreign : {"notes.txt", "fields/notes.txt", "fields/field-1.vtu",
                              "table.csv.bak", "fields/field-0001.vtu.part"}) {
    std::ofstream(folder / foreign) << "mine";
    EXPECT_EQ(posix::first_foreign(folder, names), foreign);
    EXPECT_THROW(posix::remove_own_folder(folder, names), IoError) << foreign;
    EXPECT_TRUE(fs::exists(folder / "table.csv")) << "deleted although " << foreign << " is there";
    EXPECT_TRUE(fs::exists(folder / foreign));
    fs::remove(folder / foreign);
  }
  fs::create_directories(folder / "other");
  EXPECT_THROW(posix::remove_own_folder(folder, names), IoError);
}

TEST_F(OwnFilesTest, AreNoLinks) {
  fs::create_symlink(outside.path / "victim", folder / "fields/field-0002.vtu");
  EXPECT_THROW(posix::remove_own_folder(folder, names), IoError);
  fs::remove(folder / "fields/field-0002.vtu");
  fs::create_directory_symlink(outside.path, folder / "linked");
  EXPECT_THROW(posix::remove_own_folder(folder, names), IoError);
  fs::remove(folder / "linked");
  fs::create_directory_symlink(folder, outside.path / "link");
  EXPECT_THROW(posix::remove_own_folder(outside.path / "link", names), IoError);
  EXPECT_TRUE(fs::exists(folder / "table.csv"));
  EXPECT_TRUE(fs::exists(outside.path / "victim"));
}

TEST_F(OwnFilesTest, OfKilledWritersAloneAreCleanedUp) {
  std::ofstream(folder / ".traceraft-0123456789abcdef.part") << "left";
  std::ofstream(folder / ".traceraft-mine.part") << "mine";
  fs::create_symlink(outside.path / "victim", folder / ".traceraft-0123456789abcde0.part");
  posix::remove_temporary_files(folder);
  EXPECT_FALSE(fs::exists(folder / ".traceraft-0123456789abcdef.part"));
  EXPECT_TRUE(fs::exists(folder / ".traceraft-mine.part"));
  EXPECT_TRUE(fs::exists(folder / ".traceraft-0123456789abcde0.part"));
}

}  // namespace
}  // namespace traceraft
