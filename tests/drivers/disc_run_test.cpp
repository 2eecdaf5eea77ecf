// The model of discs as a user meets it: the same commands, folders and tables.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "drivers/input/csv_table.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;
using testing::content;
using testing::ProgramEnd;
using testing::refuses;
using testing::TemporaryFolder;
using testing::traceraft;

class DiscRunTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  const std::string model =
      "--model discs --case guv-3to1 --t-end 100 --effect \"flow:membrane-viscosity=4,"
      "temperature=298\" ";
  std::string out(const std::string& name) const { return (folder.path / name).string(); }
};

TEST_F(DiscRunTest, HasTheFilesOfAnyRun) {
  const ProgramEnd end = traceraft("run " + model + "--out " + out("a"));
  ASSERT_EQ(end.code, 0) << end.output;
  for (const char* file : {"summary.json", "series.csv", "view.png", "fields/field-0016.vtu"})
    EXPECT_TRUE(fs::exists(folder.path / "a" / file)) << file;
  const input::CsvTable table = input::CsvTable::read(folder.path / "a/observables.csv");
  ASSERT_EQ(table.rows(), 17U);
  EXPECT_EQ(table.number(0, "rafts"), 40);
  EXPECT_LT(table.number(16, "rafts"), 20);
  EXPECT_EQ(table.number(0, "mass"), table.number(16, "mass"));
  // Areas of rafts.csv are the raft fraction.
  const input::CsvTable rafts = input::CsvTable::read(folder.path / "a/rafts.csv");
  double covered = 0;
  for (std::size_t row = rafts.rows() - static_cast<std::size_t>(table.number(16, "rafts"));
       row < rafts.rows(); ++row)
    covered += rafts.number(row, "area");
  EXPECT_NEAR(covered / (100 * 3.14159265358979), table.number(16, "raft_fraction"), 1e-12);
  EXPECT_EQ(traceraft("report --quiet " + out("a")).code, 0);
}

TEST_F(DiscRunTest, GoesOnBitwise) {
  const std::string run = model + "--no-fields --quiet --checkpoint-interval 0 ";
  ASSERT_EQ(traceraft("run " + run + "--out " + out("whole")).code, 0);
  ASSERT_EQ(traceraft("run " + run + "--out " + out("torn")).code, 0);
  // As if it had been killed after its last checkpoint but one.
  std::vector<fs::path> checkpoints;
  for (const auto& entry : fs::directory_iterator(folder.path / "torn/checkpoints"))
    checkpoints.push_back(entry.path());
  ASSERT_EQ(checkpoints.size(), 2U);
  fs::remove(std::max(checkpoints[0], checkpoints[1]));
  fs::remove(folder.path / "torn/summary.json");
  ASSERT_EQ(traceraft("resume --quiet " + out("torn")).code, 0);
  for (const char* table : {"series.csv", "observables.csv", "rafts.csv"})
    EXPECT_EQ(content(folder.path / "torn" / table), content(folder.path / "whole" / table));
}

TEST_F(DiscRunTest, EnsemblesHoldTheRunsThatTheirSeedsDescribe) {
  const ProgramEnd end = traceraft("ensemble " + model + "--no-fields --runs 6 --out " + out("e"));
  ASSERT_EQ(end.code, 0) << end.output;
  EXPECT_TRUE(fs::exists(folder.path / "e/ensemble.html"));
  ASSERT_EQ(traceraft("run --quiet --no-fields " + model + "--seed 4 --out " + out("alone")).code,
            0);
  EXPECT_EQ(content(folder.path / "e/runs/seed-4/series.csv"),
            content(folder.path / "alone/series.csv"));
}

TEST_F(DiscRunTest, RefusesWhatDiscsDoNotHave) {
  const std::string run = "run --model discs --validate ";
  EXPECT_TRUE(refuses(traceraft(run + "--effect gravity:strength=0.1"), "gravity"));
  EXPECT_TRUE(refuses(traceraft(run + "--effect cooling:rate=0.1"), "cooling"));
  EXPECT_TRUE(refuses(traceraft(run + "--surface torus"), "sphere"));
  EXPECT_TRUE(refuses(traceraft(run + "--initial noise"), "discs or caps"));
  EXPECT_TRUE(refuses(traceraft(run + "--integrator euler"), "model"));
  EXPECT_TRUE(refuses(traceraft(run + "--raft-fraction 0.7"), "room"));
  EXPECT_TRUE(refuses(traceraft(run + "--initial discs:number=9999"), "fewer"));
  EXPECT_TRUE(refuses(traceraft("run --validate --model disks"), "discs"));
  EXPECT_TRUE(refuses(traceraft("ensemble --model disks --out " + out("none")), "discs"));
  EXPECT_FALSE(fs::exists(folder.path / "none"));
  EXPECT_EQ(traceraft(run + "--effect 'bulk-mobility:strength=0.1; uptake:rate=1e-4'").code, 0);
}

}  // namespace
}  // namespace traceraft
