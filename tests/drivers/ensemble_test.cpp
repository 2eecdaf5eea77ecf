// Ensembles as a user meets them: side by side, interrupted, failing, on a cluster.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "drivers/input/csv_table.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;
using testing::content;
using testing::lines_of;
using testing::names;
using testing::ProgramEnd;
using testing::refuses;
using testing::shell;
using testing::TemporaryFolder;
using testing::traceraft;

class EnsembleTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  const std::string runs =
      "--case guv-2to1 --cells 20 --epsilon 0.5 --t-end 100 --no-fields --checkpoint-interval 0 ";
  std::string out(const std::string& name) const { return (folder.path / name).string(); }
  fs::path csv(const std::string& name) const { return folder.path / name / "ensemble.csv"; }
  std::vector<double> misfits(const std::string& name) const {
    return input::CsvTable::read(folder.path / name / "comparison.csv").numbers("misfit");
  }
};

TEST_F(EnsembleTest, GathersRunsThatDifferInTheirSeed) {
  const ProgramEnd made = traceraft("ensemble " + runs + "--runs 3 --out " + out("a"));
  ASSERT_EQ(made.code, 0) << made.output;
  EXPECT_TRUE(names(made.output, "a/ensemble.html"));
  EXPECT_TRUE(fs::exists(folder.path / "a/ensemble.html"));
  const std::string first = content(folder.path / "a/runs/seed-1/series.csv");
  EXPECT_NE(first, content(folder.path / "a/runs/seed-2/series.csv"));
  // A member is the run that its configuration describes.
  ASSERT_EQ(
      traceraft("run --quiet --config " + out("a/config.toml") + " --seed 1 --out " + out("alone"))
          .code,
      0);
  EXPECT_EQ(first, content(folder.path / "alone/series.csv"));
  // It can grow, and what it has is not run again.
  const auto before = fs::last_write_time(folder.path / "a/runs/seed-3/series.csv");
  ASSERT_EQ(traceraft("ensemble --quiet --runs 4 --out " + out("a")).code, 0);
  EXPECT_EQ(fs::last_write_time(folder.path / "a/runs/seed-3/series.csv"), before);
  EXPECT_TRUE(fs::exists(folder.path / "a/runs/seed-4/summary.json"));
  // Without the runs it can be compared as with them.
  fs::create_directories(folder.path / "kept");
  for (const char* file : {"config.toml", "histories.csv"})
    fs::copy_file(folder.path / "a" / file, folder.path / "kept" / file);
  fs::create_directories(folder.path / "data");
  std::ofstream(folder.path / "data/dataset.toml")
      << "name = \"few\"\nkind = \"synthetic\"\ntime_zero = \"start\"\nlength_unit = \"um\"\n"
         "time_unit = \"s\"\nradius = 5\n";
  std::ofstream(folder.path / "data/measurements.csv")
      << "vesicle,time,perimeter,rafts,fraction\na,0.001,60,4,0.2\nb,0.002,55,3,0.3\n";
  for (const char* ensemble : {"a", "kept"})
    ASSERT_EQ(traceraft("data compare --quiet " + out("data") + " --ensemble " + out(ensemble) +
                        " --out " + out(std::string("by-") + ensemble))
                  .code,
              0);
  EXPECT_EQ(traceraft("report --quiet " + out("by-kept")).code, 0);
  EXPECT_EQ(content(folder.path / "by-kept/report.html"),
            content(folder.path / "by-kept/comparison.html"));
  // A report of the ensemble shows it, and says when it is of other runs than there are.
  ASSERT_EQ(traceraft("data compare --quiet " + out("data") + " --ensemble " + out("a")).code, 0);
  ASSERT_EQ(traceraft("report --quiet " + out("a")).code, 0);
  const fs::path page = folder.path / "a/report.html";
  EXPECT_TRUE(names(content(page), "SYNTHETIC"));
  EXPECT_FALSE(names(content(page), "OUT OF DATE"));
  ASSERT_EQ(traceraft("ensemble --quiet --runs 5 --out " + out("a")).code, 0);
  ASSERT_EQ(traceraft("report --quiet " + out("a")).code, 0);
  EXPECT_TRUE(names(content(page), "OUT OF DATE"));
  const std::vector<double> with = misfits("by-a"), without = misfits("by-kept");
  ASSERT_EQ(with.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(without[k], with[k], 0.1 * with[k]);
}

TEST_F(EnsembleTest, GoesOnAfterItWasKilled) {
  ASSERT_EQ(traceraft("ensemble --quiet " + runs + "--runs 3 --out " + out("whole")).code, 0);
  const pid_t child = testing::start_traceraft("ensemble --quiet " + runs +
                                               "--runs 3 --jobs 2 --out " + out("cut"));
  for (int i = 0; i < 6000 && lines_of(folder.path / "cut/runs/seed-1/series.csv") < 20; ++i)
    usleep(10000);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  ASSERT_FALSE(fs::exists(csv("cut")));
  // Its runs end by themselves when it has died; until then they hold their folders.
  ProgramEnd again{6, ""};
  for (int i = 0; i < 100 && again.code != 0; ++i) {
    usleep(100000);
    again = traceraft("ensemble --quiet --out " + out("cut"));
  }
  ASSERT_EQ(again.code, 0) << again.output;
  EXPECT_EQ(content(csv("cut")), content(csv("whole")));
}

// A simulation of its own among its runs would be nobody's.
TEST_F(EnsembleTest, IsNoRunToResume) {
  ASSERT_EQ(traceraft("ensemble --quiet " + runs + "--runs 2 --out " + out("a")).code, 0);
  EXPECT_TRUE(refuses(traceraft("resume " + out("a")), out("a")));
  EXPECT_FALSE(fs::exists(folder.path / "a/series.csv"));
  fs::remove(folder.path / "a/plan.json");
  const ProgramEnd again = traceraft("ensemble --quiet " + runs + "--runs 2 --out " + out("a"));
  EXPECT_EQ(again.code, 2);
  EXPECT_FALSE(names(again.output, "traceraft resume"));
}

TEST_F(EnsembleTest, StopsWhenItIsAskedTo) {
  const pid_t child =
      testing::start_traceraft("ensemble --quiet " + runs + "--runs 4 --jobs 1 --out " + out("a"));
  for (int i = 0; i < 6000 && lines_of(folder.path / "a/runs/seed-1/series.csv") < 20; ++i)
    usleep(10000);
  kill(child, SIGTERM);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 5);
  EXPECT_FALSE(fs::exists(folder.path / "a/runs/seed-2"));
}

// The children of a process.
std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> children;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "stat");
    pid_t process = 0, its_parent = 0;
    std::string name, state;
    if (file >> process >> name >> state >> its_parent && its_parent == parent)
      children.push_back(process);
  }
  return children;
}

TEST_F(EnsembleTest, IsolatesARunThatCrashes) {
  const std::string log = out("log");
  const pid_t child = testing::start_traceraft("ensemble " + runs + "--runs 3 --jobs 1 --out " +
                                               out("a") + " > " + log + " 2>&1");
  for (int i = 0; i < 6000 && lines_of(folder.path / "a/runs/seed-1/series.csv") < 5; ++i)
    usleep(10000);
  const std::vector<pid_t> members = children_of(child);
  EXPECT_EQ(members.size(), 1u);
  for (const pid_t member : members) kill(member, SIGBUS);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 3);
  for (const char* fact : {"seed 1 failed", "Bus error"}) EXPECT_TRUE(names(content(log), fact));
  EXPECT_TRUE(names(content(folder.path / "a/ensemble.html"), "2 of 3 runs"));
}

TEST_F(EnsembleTest, IsolatesARunThatFails) {
  fs::create_directories(folder.path / "a/runs");
  std::ofstream(folder.path / "a/plan.json") << "{\"runs\": 3, \"first_seed\": 1}\n";
  std::ofstream(folder.path / "a/runs/seed-2") << "in the way";
  const ProgramEnd made = traceraft("ensemble " + runs + "--runs 3 --out " + out("a"));
  EXPECT_EQ(made.code, 3) << made.output;
  EXPECT_TRUE(names(made.output, "seed 2 failed"));
  EXPECT_TRUE(names(content(folder.path / "a/ensemble.html"), "2 of 3 runs"));
  fs::remove(folder.path / "a/runs/seed-2");
  EXPECT_EQ(traceraft("ensemble --quiet --out " + out("a")).code, 0);
}

// Files that were damaged after their run had finished are their member's own.
TEST_F(EnsembleTest, GathersTheOthersOfADamagedRun) {
  ASSERT_EQ(traceraft("ensemble --quiet " + runs + "--runs 4 --out " + out("a")).code, 0);
  const std::string compare =
      "data compare " TRACERAFT_ROOT "/verification/data/synthetic/guv-2to1 --ensemble " + out("a");
  EXPECT_FALSE(names(traceraft(compare).output, "OF 4 RUNS"));
  fs::rename(folder.path / "a/runs/seed-4", folder.path / "seed-4");
  EXPECT_TRUE(names(traceraft(compare).output, "3 OF 4 RUNS"));
  fs::rename(folder.path / "seed-4", folder.path / "a/runs/seed-4");
  const fs::path first = folder.path / "a/runs/seed-1/series.csv";
  std::string series = content(first);
  series.resize(series.rfind('\n', series.size() / 2) + 1);
  std::ofstream(first) << series;
  std::ofstream(folder.path / "a/runs/seed-2/series.csv") << "step,t,mass\n1,2,3\n";
  std::ofstream(folder.path / "a/runs/seed-3/summary.json") << "{";
  const ProgramEnd made = traceraft("ensemble --out " + out("a"));
  EXPECT_EQ(made.code, 3) << made.output;
  // Each failure names the folder to delete.
  for (const char* fact : {"seed 1 failed", "seed 2 failed", "seed 3 failed", "a/runs/seed-1 ",
                           "a/runs/seed-2 ", "a/runs/seed-3 "})
    EXPECT_TRUE(names(made.output, fact));
  EXPECT_TRUE(names(content(folder.path / "a/ensemble.html"), "1 of 4 runs"));
  // A run that is there but cannot be read is not to be deleted.
  fs::remove(folder.path / "a/runs/seed-3/summary.json");
  fs::create_directory(folder.path / "a/runs/seed-3/summary.json");
  const ProgramEnd unread = traceraft("ensemble --out " + out("a"));
  EXPECT_TRUE(names(unread.output, "seed 3 failed"));
  EXPECT_FALSE(names(unread.output, "a/runs/seed-3 "));
  ASSERT_EQ(traceraft("report " + out("a")).code, 0);
  const std::string page = content(folder.path / "a/report.html");
  for (const char* fact : {"seed-4", "seed 2"}) EXPECT_TRUE(names(page, fact));
  // Time goes on to the end of the run that is whole.
  EXPECT_NEAR(input::CsvTable::read(csv("a")).numbers("t").back(), 100, 10);
}

// Runs that differ in more than their seed would be taken for one sample.
TEST_F(EnsembleTest, RefusesRunsOfAnother) {
  ASSERT_EQ(traceraft("ensemble --quiet " + runs + "--runs 2 --out " + out("a")).code, 0);
  fs::rename(folder.path / "a/runs/seed-2", folder.path / "second");
  fs::copy(folder.path / "a/runs/seed-1", folder.path / "a/runs/seed-2",
           fs::copy_options::recursive);
  ProgramEnd made = traceraft("ensemble --out " + out("a"));
  EXPECT_EQ(made.code, 3) << made.output;
  EXPECT_TRUE(names(made.output, "seed 2 failed")) << made.output;
  EXPECT_TRUE(names(made.output, "in seed")) << made.output;
  fs::remove_all(folder.path / "a/runs/seed-2");
  fs::rename(folder.path / "second", folder.path / "a/runs/seed-2");
  EXPECT_EQ(traceraft("ensemble --out " + out("a")).code, 0);
  std::string config = content(folder.path / "a/config.toml");
  config.replace(config.find("epsilon = 0.5"), 13, "epsilon = 0.4");
  std::ofstream(folder.path / "a/config.toml") << config;
  made = traceraft("ensemble --out " + out("a"));
  EXPECT_EQ(made.code, 3) << made.output;
  EXPECT_TRUE(names(made.output, "in epsilon")) << made.output;
}

TEST_F(EnsembleTest, IsAnArrayJobToo) {
  ASSERT_EQ(
      traceraft("ensemble --quiet " + runs + "--runs 2 --first-seed 7 --out " + out("here")).code,
      0);
  const ProgramEnd script =
      traceraft("ensemble " + runs + "--runs 2 --first-seed 7 --array-job --out '" +
                out("there it is") + "'");
  ASSERT_EQ(script.code, 0) << script.output;
  const fs::path job = folder.path / "there it is/array-job.sh";
  EXPECT_TRUE(names(content(job), "#SBATCH --array=0-1\n"));
  const ProgramEnd finer =
      traceraft("ensemble --case guv-2to1 --cells 256 --runs 1 --array-job --out " + out("finer"));
  EXPECT_EQ(finer.code, 0) << finer.output;
  for (const char* fact : {"2 processors", "8 GB", "8 h"}) EXPECT_TRUE(names(finer.output, fact));
  const ProgramEnd following =
      traceraft("ensemble --case guv-2to1 --runs 1 --array-job --out " + out("following"));
  for (const char* fact : {"8 GB", "1 h"}) EXPECT_TRUE(names(following.output, fact));
  for (const char* line : {"#SBATCH --mem=2G\n", "#SBATCH --time=1:00:00\n"})
    EXPECT_TRUE(names(content(job), line));
  for (const char* task : {"0", "1"}) {
    const ProgramEnd done =
        shell("SLURM_ARRAY_TASK_ID=" + std::string(task) + " sh '" + job.string() + "'");
    ASSERT_EQ(done.code, 0);
    EXPECT_TRUE(names(done.output, task == std::string("0") ? "seed 7: " : "seed 8: "));
  }
  ASSERT_EQ(traceraft("ensemble --quiet --out '" + out("there it is") + "'").code, 0);
  EXPECT_EQ(content(csv("there it is")), content(csv("here")));
}

// Clusters allow some 1000 tasks, of which each may have several runs, and fewer at a time.
TEST_F(EnsembleTest, IsAnArrayJobOfFewTasks) {
  const ProgramEnd many = traceraft(
      "ensemble --case guv-2to1 --cells 20 --epsilon 0.5 --runs 2500 "
      "--array-job --array-throttle 50 --out " +
      out("many"));
  ASSERT_EQ(many.code, 0) << many.output;
  const std::string job = content(folder.path / "many/array-job.sh");
  for (const char* text : {"#SBATCH --array=0-833%50\n", "#SBATCH --time=3:00:00\n",
                           " --member \"$((1 + 3 * SLURM_ARRAY_TASK_ID))\" --members 3 "})
    EXPECT_TRUE(names(job, text));
  ASSERT_EQ(traceraft("ensemble --quiet " + runs + "--runs 3 --out " + out("here")).code, 0);
  ASSERT_EQ(traceraft("ensemble --quiet " + runs + "--runs 3 --array-job --array-tasks 2 --out " +
                      out("there"))
                .code,
            0);
  for (const char* task : {"0", "1"}) {
    const ProgramEnd done =
        shell("SLURM_ARRAY_TASK_ID=" + std::string(task) + " sh " + out("there") + "/array-job.sh");
    EXPECT_EQ(done.code, 0) << done.output;
    EXPECT_EQ(fs::exists(folder.path / "there/runs/seed-3/summary.json"), *task == '1') << task;
  }
  ASSERT_EQ(traceraft("ensemble --quiet --out " + out("there")).code, 0);
  EXPECT_EQ(content(csv("there")), content(csv("here")));
  // The folder that it is started from has a line break in its name.
  const ProgramEnd broken = shell("mkdir '" + out("a\nb") + "' && cd '" + out("a\nb") +
                                  "' && exec " + std::string(TRACERAFT_PROGRAM) + " ensemble " +
                                  runs + "--runs 2 --array-job --out here");
  EXPECT_TRUE(refuses(broken, "--array-job")) << broken.output;
  EXPECT_FALSE(fs::exists(folder.path / "a\nb/here"));
  for (const char* flag : {"--array-tasks 5", "--array-throttle 5", "--members 2"}) {
    const ProgramEnd alone = traceraft("ensemble --case guv-2to1 " + std::string(flag));
    EXPECT_EQ(alone.code, 2) << flag;
    EXPECT_EQ(std::count(alone.output.begin(), alone.output.end(), '\n'), 1) << alone.output;
  }
}

// Killed before the first run: a plan, or the plan and no configuration.
TEST_F(EnsembleTest, BeginsAgainWhereNothingHadBegun) {
  fs::create_directories(folder.path / "a/runs");
  std::ofstream(folder.path / "a/plan.json") << "{\"runs\": 1, \"first_seed\": 1}\n";
  EXPECT_EQ(traceraft("ensemble --quiet " + runs + "--runs 1 --out " + out("a")).code, 0);
}

// The program takes configurations that it wrote, and keeps its hands off a campaign.
TEST_F(EnsembleTest, TakesAnyConfigurationAndNoOtherPlan) {
  ASSERT_EQ(traceraft("ensemble --quiet " + runs + "--runs 1 --out " + out("a")).code, 0);
  ASSERT_EQ(
      traceraft("ensemble --quiet --config " + out("a/config.toml") + " --runs 1 --out " + out("b"))
          .code,
      0);
  EXPECT_EQ(content(csv("a")), content(csv("b")));
  // The same command goes on, however numbers are written.
  const std::string same =
      "ensemble --quiet --case guv-2to1 --cells 20 --epsilon 5e-1 --t-end 1e2 "
      "--no-fields --checkpoint-interval 0.0 --runs 1 --out ";
  const ProgramEnd again = traceraft(same + out("a"));
  EXPECT_EQ(again.code, 0) << again.output;
  fs::create_directories(folder.path / "c");
  std::ofstream(folder.path / "c/plan.json") << "{\"groups\": []}\n";
  const ProgramEnd refused = traceraft("ensemble --quiet " + runs + "--runs 1 --out " + out("c"));
  EXPECT_TRUE(refuses(refused, "c/plan.json"));
  EXPECT_EQ(content(folder.path / "c/plan.json"), "{\"groups\": []}\n");
}

TEST_F(EnsembleTest, LeavesFoldersOfOthersAlone) {
  fs::create_directories(folder.path / "mine");
  std::ofstream(folder.path / "mine/histories.csv") << "mine\n";
  const ProgramEnd refused = traceraft("ensemble " + runs + "--runs 1 --out " + out("mine"));
  EXPECT_TRUE(refuses(refused, "histories.csv"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path / "mine"), {}), 1);
}

TEST_F(EnsembleTest, RefusesWhatMakesNoEnsemble) {
  ASSERT_EQ(traceraft("ensemble --quiet " + runs + "--runs 1 --out " + out("a")).code, 0);
  std::string config = content(folder.path / "a/config.toml");
  const std::string key = "checkpoint-interval = ";
  ASSERT_NE(config.find(key), std::string::npos);
  config.insert(config.find(key) + key.size(), "7");
  std::ofstream(folder.path / "other.toml") << config;
  for (const auto& [flags, complaint] :
       {std::pair("--runs 2 --config " + out("other.toml") + " --out " + out("a"),
                  "checkpoint-interval"),
        std::pair("--case two-rafts --out " + out("b"), "noise"),
        std::pair("--case guv-3to1 --out " + out("a"), "--out: "),
        std::pair("--first-seed 3 --out " + out("a"), "seed 1"),
        std::pair("--case guv-2to1 --cells 20 --epsilon 0.5 --t-end 100 --checkpoint-interval 5 "
                  "--out " +
                      out("a"),
                  "checkpoint-interval"),
        std::pair("--member 9 --out " + out("a"), "allowed: 1 to 1"),
        std::pair("--member 1 --out " + out("c"), "--out"),
        std::pair(runs + "--seed 3 --out " + out("d"), "'--seed'")})
    EXPECT_TRUE(refuses(traceraft("ensemble " + flags), complaint)) << flags;
}

}  // namespace
}  // namespace traceraft
