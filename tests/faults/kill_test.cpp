// Runs that are killed again and again lose nothing.
#include <gtest/gtest.h>

#include "backends/posix/own_files.hpp"
#include "drivers/run/checkpoint_store.hpp"
#include "drivers/run/run_folder.hpp"
#include "kernel/core/random.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::content;
using testing::start_traceraft;
using testing::traceraft;
namespace fs = std::filesystem;

constexpr int kKills = 50;
constexpr char kRun[] =
    "run --quiet --case spinodal --cells 16 --t-end 2 --checkpoint-interval 0 --seed ";

// The n-th kill comes that late after its process was started.
void kill_after_a_while(pid_t child, int number) {
  constexpr double kLongest = 0.7;  // s; runs take about a second
  usleep(static_cast<useconds_t>(1e6 * kLongest *
                                 uniform_random(11, 0, static_cast<std::uint64_t>(number))));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
}

TEST(Kills, LoseNothing) {
  const testing::TemporaryFolder folder;
  const std::string whole = (folder.path / "whole").string(),
                    torn = (folder.path / "torn").string();
  ASSERT_EQ(traceraft(kRun + std::string("3 --out ") + whole).code, 0);
  int kills = 0, finished = 0;
  while (kills < kKills || finished == 0) {
    const bool begun = fs::exists(torn + "/config.toml");
    const pid_t child =
        start_traceraft(begun ? "resume --quiet " + torn : kRun + std::string("3 --out ") + torn);
    if (kills < kKills) {
      kill_after_a_while(child, kills++);
    } else {
      int status = 0;
      waitpid(child, &status, 0);
      ASSERT_TRUE(WIFEXITED(status));
      ASSERT_EQ(WEXITSTATUS(status), 0);
    }
    if (!fs::exists(torn + "/summary.json")) continue;
    // It has come to its end: everything is as if nothing had happened. Then it begins anew.
    ++finished;
    for (const char* table : {"series.csv", "observables.csv", "rafts.csv", "config.toml"})
      EXPECT_TRUE(content(torn + "/" + table) == content(whole + "/" + table)) << table;
    EXPECT_EQ(posix::first_foreign(torn, run::files_of_a_run()), "");
    const run::Checkpoint a = run::CheckpointStore(torn + "/checkpoints").newest(),
                          b = run::CheckpointStore(whole + "/checkpoints").newest();
    EXPECT_TRUE(a.concentration == b.concentration);
    fs::remove_all(torn);
  }
  RecordProperty("runs that reached their end", finished);
}

// Every bit that is flipped in a table is noticed before anything is cut off or added.
TEST(Damage, OfTablesIsNoticedBeforeARunGoesOn) {
  const testing::TemporaryFolder folder;
  const std::string run = (folder.path / "r").string();
  const pid_t child = start_traceraft(kRun + std::string("1 --out ") + run);
  for (int i = 0; i < 3000 && testing::lines_of(run + "/series.csv") < 30; ++i) usleep(5000);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const run::Checkpoint last = run::CheckpointStore(run + "/checkpoints").newest();
  for (const char* name : {"series.csv", "observables.csv", "rafts.csv"}) {
    const std::string path = run + "/" + name, rows = content(path);
    const auto counted = static_cast<double>(last.tables.at(name).bytes);
    for (std::uint64_t k = 0; k < 4; ++k) {
      std::string bad = rows;
      const auto at = static_cast<std::size_t>(counted * uniform_random(5, k, bad.size()));
      bad[at] = static_cast<char>(bad[at] ^ (1 << (k % 8)));
      posix::write_durably(path, bad);
      const testing::ProgramEnd end = traceraft("resume --quiet " + run);
      EXPECT_EQ(end.code, 4) << end.output;
      EXPECT_NE(end.output.find(name), std::string::npos) << end.output;
      EXPECT_TRUE(content(path) == bad);
    }
    posix::write_durably(path, rows);
  }
  EXPECT_EQ(traceraft("resume --quiet " + run).code, 0);
  // And of a run that has reached its end before it is shown.
  std::string bad = content(run + "/series.csv");
  bad[bad.size() / 2] ^= 1;
  posix::write_durably(run + "/series.csv", bad);
  EXPECT_EQ(traceraft("report " + run).code, 4);
}

}  // namespace
}  // namespace traceraft
