#include "drivers/run/checkpoint_store.hpp"

#include <gtest/gtest.h>

#include "backends/posix/durable_file.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/random.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::TemporaryFolder;

run::Checkpoint sample(long step) {
  run::Checkpoint checkpoint;
  checkpoint.configuration = "cells = 16\n";
  checkpoint.tables = {{"series.csv", {1234, 0xDEADBEEF}}, {"rafts.csv", {99, 7}}};
  checkpoint.state = std::string(5000, 'q') + std::to_string(step);
  checkpoint.concentration = {0.25, 0.5, 1.0 / 3};
  checkpoint.forest = {true, false, false, true, true, false, false, false, true, false, true};
  checkpoint.step = step;
  checkpoint.cost.wall_seconds = 1.5;
  checkpoint.cost.cpu_seconds = 2.5;
  return checkpoint;
}

std::size_t count_files(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) count += entry.exists();
  return count;
}

TEST(Checkpoint, RoundTrips) {
  const run::Checkpoint a = sample(7), b = run::decode(run::encode(a));
  EXPECT_EQ(a.configuration, b.configuration);
  EXPECT_TRUE(a.tables == b.tables);
  EXPECT_EQ(a.state, b.state);
  EXPECT_EQ(a.concentration, b.concentration);
  EXPECT_EQ(a.forest, b.forest);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.cost.wall_seconds, b.cost.wall_seconds);
  EXPECT_EQ(a.cost.cpu_seconds, b.cost.cpu_seconds);
}

TEST(Checkpoint, AnyDamageIsRefused) {
  const std::string good = run::encode(sample(3));
  for (std::size_t size = 0; size < good.size(); size += 37)
    EXPECT_THROW(run::decode(good.substr(0, size)), IoError) << size;
  EXPECT_THROW(run::decode(good + "x"), IoError);
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    std::string bad = good;
    const auto at = static_cast<std::size_t>(uniform_random(seed, 0, 0) * bad.size());
    const char before = bad[at];
    bad[at] = static_cast<char>(256 * uniform_random(seed, 0, 1));
    if (bad[at] != before) {
      EXPECT_THROW(run::decode(bad), IoError) << at;
    }
  }
}

TEST(CheckpointStore, KeepsTheTwoNewestAndNothingOfOthers) {
  const TemporaryFolder folder;
  posix::write_durably(folder.path / "notes.txt", "mine");
  posix::write_durably(folder.path / "step-old.ckpt", "not ours either");
  run::CheckpointStore store(folder.path);
  for (const long step : {1, 20, 300, 4000}) store.write(sample(step));
  EXPECT_EQ(count_files(folder.path), 4u);
  std::vector<std::string> refused;
  EXPECT_EQ(store.newest(refused).step, 4000);
  EXPECT_TRUE(refused.empty());
}

TEST(CheckpointStore, PassesOverADamagedOneAndSaysSo) {
  const TemporaryFolder folder;
  run::CheckpointStore store(folder.path);
  std::vector<std::string> refused;
  EXPECT_THROW(store.newest(refused), IoError);
  store.write(sample(1));
  store.write(sample(2));
  const auto newest = folder.path / "step-0000000002.ckpt";
  posix::write_durably(newest, posix::read_file(newest, 1 << 20).substr(0, 3000));
  EXPECT_EQ(store.newest(refused).step, 1);
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_NE(refused[0].find("step-0000000002.ckpt: its end is missing"), std::string::npos);
}

}  // namespace
}  // namespace traceraft
