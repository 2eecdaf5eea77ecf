// The program as a user meets it: exit codes, files, interruption.
#include "tests/support/program.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "kernel/core/stopwatch.hpp"
#include "kernel/core/text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::content;
using testing::json_of;
using testing::lines_of;
using testing::names;
using testing::ProgramEnd;
using testing::refuses;
using testing::shell;
using testing::TemporaryFolder;
using testing::traceraft;
namespace fs = std::filesystem;

class ProgramTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  // About 60 steps in a second or two.
  const std::string quick = "--case two-rafts --cells 16 --epsilon 0.8 --t-end 0.5 ";
  std::string out(const std::string& name) const { return (folder.path / name).string(); }

  // Starts a run in the background; the caller ends it.
  pid_t start(const std::string& name, const std::string& more = "--threads 2") {
    return testing::start_traceraft("run " + quick + more +
                                    " --checkpoint-interval 0 --quiet --out " + out(name));
  }
  static void kill_running(pid_t child) {
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "it had come to its end";
  }
  void wait_for_rows(const std::string& name, long rows) const {
    for (int i = 0; i < 6000 && lines_of(folder.path / name / "series.csv") < rows; ++i)
      usleep(10000);
    ASSERT_GE(lines_of(folder.path / name / "series.csv"), rows);
  }
  void expect_same_results(const std::string& a, const std::string& b) const {
    for (const char* table : {"series.csv", "observables.csv", "rafts.csv"})
      EXPECT_EQ(content(folder.path / a / table), content(folder.path / b / table)) << table;
    for (const auto& entry : fs::directory_iterator(folder.path / a / "fields"))
      EXPECT_EQ(content(entry.path()),
                content(folder.path / b / "fields" / entry.path().filename()));
  }
};

TEST_F(ProgramTest, RunsAndWritesWhatItPromises) {
  const ProgramEnd run = traceraft("run " + quick + "--output-times 0,0.1,0.5 --out " + out("a"));
  ASSERT_EQ(run.code, 0) << run.output;
  // Numbers with their units, and what to open next.
  for (const char* fact : {" um", "R^2/D", "view.png"}) EXPECT_TRUE(names(run.output, fact));
  EXPECT_EQ(run.output.find('\r'), std::string::npos) << "no terminal, no rewriting of lines";
  const auto summary = json_of(folder.path / "a/summary.json");
  for (const char* key : {"nodes", "unknowns", "steps", "rejected", "mass_drift", "energy_rises",
                          "energy", "perimeter", "rafts", "cpu_s", "wall_s", "peak_memory_mb",
                          "integrator", "linear_solver", "seed", "version"})
    EXPECT_TRUE(summary.contains(key)) << key;
  EXPECT_LT(summary["mass_drift"].get<double>(), 1e-12);
  const std::string series = content(folder.path / "a/series.csv");
  EXPECT_EQ(series.rfind("steps,t (", 0), 0u);
  EXPECT_EQ(lines_of(folder.path / "a/series.csv"), summary["steps"].get<long>() + 2);
  const std::string observables = content(folder.path / "a/observables.csv");
  EXPECT_EQ(lines_of(folder.path / "a/observables.csv"), 4);
  EXPECT_TRUE(names(observables, ",0.1,"));
  EXPECT_TRUE(fs::exists(folder.path / "a/fields/field-0002.vtu"));
  EXPECT_TRUE(names(content(folder.path / "a/fields.pvd"), "fields/field-0002.vtu"));
}

// ./run becomes the program once it has built it, minutes after the process began.
TEST_F(ProgramTest, TimeBeforeTheProgramWasStartedIsNotCounted) {
  const Stopwatch watch;
  const ProgramEnd end = shell("sh -c 'sleep 2; exec " + std::string(TRACERAFT_PROGRAM) + " run " +
                               quick + "--quiet --out " + out("run") + "'");
  const double all = watch.seconds();
  ASSERT_EQ(end.code, 0) << end.output;
  const auto summary = json_of(folder.path / "run/summary.json");
  EXPECT_GT(summary["wall_s"], 0);
  EXPECT_LT(summary["wall_s"], all - 1.9);
}

TEST_F(ProgramTest, TakesTheSameStepsWhateverIsAskedFor) {
  ASSERT_EQ(traceraft("run --quiet " + quick + "--out " + out("few")).code, 0);
  ASSERT_EQ(
      traceraft("run --quiet " + quick + "--output-times 0.01,0.02,0.0213,0.3 --out " + out("many"))
          .code,
      0);
  EXPECT_EQ(content(folder.path / "few/series.csv"), content(folder.path / "many/series.csv"));
}

// The same vesicle in µm and s, and in units of R and R²/D.
TEST_F(ProgramTest, WritesInTheUnitsOfItsModel) {
  constexpr double kR = 5, kUnitOfTime = kR * kR * 1e-8 / 1e-5;  // of D = 1e-5 cm²/s
  const std::string run = "run --quiet --case two-rafts --cells 16 --no-fields ";
  ASSERT_EQ(traceraft(run + "--scaled --epsilon 0.16 --t-end 1 --out " + out("scaled")).code, 0);
  ASSERT_EQ(traceraft(run +
                      formatted("--radius %g --epsilon %g --t-end %.17g --out ", kR, 0.16 * kR,
                                kUnitOfTime) +
                      out("physical"))
                .code,
            0);
  const auto row = [&](const std::string& name) {
    return json_of(folder.path / name / "summary.json");
  };
  const auto scaled = row("scaled"), physical = row("physical");
  for (const auto& [key, unit] : {std::pair("area", kR * kR),
                                  {"mass", kR * kR},
                                  {"energy", kR * kR},
                                  {"perimeter", kR},
                                  {"perimeter_level", kR},
                                  {"t", kUnitOfTime},
                                  {"h", kR},
                                  {"raft_fraction", 1.0},
                                  {"c_max", 1.0},
                                  {"rafts", 1.0},
                                  {"steps", 1.0}})
    EXPECT_NEAR(physical.at(key).get<double>(), unit * scaled.at(key).get<double>(),
                1e-6 * unit * std::fabs(scaled.at(key).get<double>()))
        << key;
}

TEST_F(ProgramTest, AFailedClaimOfAStudyExitsWithOne) {
  const std::string verify = "verify geometry --quick --out " + out("v");
  const ProgramEnd good = traceraft(verify);
  ASSERT_EQ(good.code, 0) << good.output;
  auto result = json_of(folder.path / "v/geometry.json");
  result.at("claims").at(0).at("measured") = 7;
  posix::write_durably(folder.path / "v/geometry.json", result.dump());
  const ProgramEnd bad = traceraft(verify);  // which takes the study from there
  EXPECT_EQ(bad.code, 1) << bad.output;
}

TEST_F(ProgramTest, TakesEffectsByOneFlagOrSeveral) {
  const std::string run = "run --quiet " + quick;
  ASSERT_EQ(
      traceraft(run + "--effect 'uptake:rate=1; gravity:strength=0.1' --out " + out("one")).code,
      0);
  ASSERT_EQ(
      traceraft(run + "--effect uptake:rate=1 --effect gravity:strength=0.1 --out " + out("two"))
          .code,
      0);
  expect_same_results("one", "two");
}

TEST_F(ProgramTest, RepeatsItselfBitwiseOnAnyNumberOfThreads) {
  ASSERT_EQ(traceraft("run --quiet --threads 1 " + quick + "--out " + out("a")).code, 0);
  ASSERT_EQ(traceraft("run --quiet --threads 2 " + quick + "--out " + out("b")).code, 0);
  expect_same_results("a", "b");
}

TEST_F(ProgramTest, ContinuesBitwiseAfterBeingKilledAtAnyMoment) {
  ASSERT_EQ(traceraft("run --quiet " + quick + "--out " + out("whole")).code, 0);
  for (const long rows : {2, 9, 30}) {
    const std::string name = "killed" + std::to_string(rows);
    const pid_t child = start(name);
    wait_for_rows(name, rows);
    kill_running(child);
    const ProgramEnd resumed = traceraft("resume --quiet " + out(name));
    ASSERT_EQ(resumed.code, 0) << resumed.output;
    expect_same_results("whole", name);
  }
}

TEST_F(ProgramTest, ContinuesBitwiseWithOtherMethods) {
  for (const char* method : {"--linear-solver direct --threads 2 ", "--integrator euler ",
                             "--integrator rosenbrock --tolerance 1e-4 "}) {
    const std::string name = std::to_string(std::string(method).size());
    ASSERT_EQ(traceraft("run --quiet " + quick + method + "--out " + out("whole" + name)).code, 0);
    const pid_t child = start("killed" + name, method);
    wait_for_rows("killed" + name, 12);
    kill_running(child);
    ASSERT_EQ(traceraft("resume --quiet " + out("killed" + name)).code, 0);
    expect_same_results("whole" + name, "killed" + name);
  }
}

TEST_F(ProgramTest, FollowsBoundariesAndContinuesBitwiseAcrossMeshes) {
  const std::string run =
      "run --quiet --threads 1 --case two-rafts --mesh adaptive --cells 64 --epsilon 0.2 "
      "--t-end 1.5 --checkpoint-interval 0 --out ";
  ASSERT_EQ(traceraft(run + out("whole")).code, 0);
  const pid_t child = testing::start_traceraft(run + out("killed"));
  wait_for_rows("killed", 25);
  kill_running(child);
  ASSERT_EQ(traceraft("resume --quiet " + out("killed")).code, 0);
  expect_same_results("whole", "killed");
  const auto summary = json_of(folder.path / "whole/summary.json");
  EXPECT_GE(summary["remeshes"], 1);
  EXPECT_LT(summary["mean_nodes"], 9000);  // of 10,912
  EXPECT_LT(summary["mass_drift"], 1e-12);
  EXPECT_EQ(summary["energy_rises"], 0);
}

// Files hold the default of --keep, which such a flow does not allow euler to have.
TEST_F(ProgramTest, ContinuesRunsWithFlow) {
  for (const std::string method : {"ida", "euler"}) {
    const std::string run =
        "run --quiet --threads 1 --case two-rafts --cells 16 --epsilon 0.8 --t-end 0.4 --effect "
        "flow:capillary=100,thermal=1e-4 --checkpoint-interval 0 --integrator " +
        method + " --out ";
    ASSERT_EQ(traceraft(run + out("whole-" + method)).code, 0);
    const pid_t child = testing::start_traceraft(run + out("killed-" + method));
    wait_for_rows("killed-" + method, 5);
    kill_running(child);
    const ProgramEnd resumed = traceraft("resume --quiet " + out("killed-" + method));
    ASSERT_EQ(resumed.code, 0) << resumed.output;
    expect_same_results("whole-" + method, "killed-" + method);
    EXPECT_EQ(traceraft("run --validate --config " + out("whole-" + method) + "/config.toml").code,
              0);
  }
  EXPECT_TRUE(refuses(traceraft("run --validate --case two-rafts --integrator euler --keep second "
                                "--effect flow:capillary=100"),
                      "--keep"));
}

TEST_F(ProgramTest, SaysWhereNoMeshCanFollow) {
  const std::string run = "run --validate --mesh adaptive --case two-rafts ";
  EXPECT_TRUE(refuses(traceraft(run + "--effect thermal:strength=1e-6"), "uniform"));
  EXPECT_TRUE(refuses(traceraft(run + "--cells 100 --mesh-levels 3"), "nearest: 104"));
  EXPECT_TRUE(refuses(traceraft(run + "--cells 17"), "--mesh uniform"));
  EXPECT_TRUE(
      refuses(traceraft("run --validate --mesh uniform --mesh-levels 3"), "--mesh adaptive"));
  EXPECT_TRUE(refuses(traceraft("run --validate --mesh fine"), "uniform, adaptive"));
  EXPECT_TRUE(refuses(traceraft("run --validate --cells 64 --cells-per-boundary 4"), "either"));
  const ProgramEnd end = traceraft("run --validate --scaled --epsilon 0.1 --cells-per-boundary 4");
  EXPECT_TRUE(names(end.output, "32 cells per edge")) << end.output;
}

// A case asks for a mesh that follows; its user for noise in every cell.
TEST_F(ProgramTest, RunsACaseOnEqualCellsWhereNoMeshCanFollow) {
  const std::string run = "run --validate --case guv-2to1 ";
  EXPECT_TRUE(names(traceraft(run).output, "256 cells per edge and, away from boundaries"));
  const ProgramEnd noisy = traceraft(run + "--effect thermal:strength=1e-6");
  EXPECT_TRUE(names(noisy.output, "128 cells per edge, ")) << noisy.output;
  const std::string octahedron = "--surface formula --surface-formula 'abs(x)+abs(y)+abs(z)-1' ";
  EXPECT_TRUE(refuses(traceraft(run + octahedron), "128 per edge"));
  EXPECT_TRUE(refuses(traceraft(run + "--mesh adaptive " + octahedron), "--mesh uniform"));
  const std::string inside_out = "--surface formula --surface-formula 1-x^2-y^2-z^2 ";
  EXPECT_TRUE(refuses(traceraft(run + "--mesh adaptive " + inside_out), "change its sign"));
  const std::string asked = run + "--mesh adaptive --effect thermal:strength=1e-6";
  EXPECT_TRUE(refuses(traceraft(asked), "--mesh: effect thermal"));
}

TEST_F(ProgramTest, StartsAgainWhenKilledBeforeTheFirstCheckpoint) {
  ASSERT_EQ(traceraft("run --quiet " + quick + "--out " + out("whole")).code, 0);
  // The folder as a kill right after the configuration was written leaves it.
  fs::create_directory(folder.path / "early");
  posix::write_durably(folder.path / "early/config.toml",
                       content(folder.path / "whole/config.toml"));
  const ProgramEnd resumed = traceraft("resume " + out("early"));
  ASSERT_EQ(resumed.code, 0) << resumed.output;
  expect_same_results("whole", "early");
}

TEST_F(ProgramTest, StopsCleanlyWhenAskedToAndContinues) {
  ASSERT_EQ(traceraft("run --quiet " + quick + "--out " + out("whole")).code, 0);
  for (const int signal : {SIGINT, SIGTERM}) {
    const std::string name = "stopped" + std::to_string(signal);
    const pid_t child = start(name);
    wait_for_rows(name, 10);
    kill(child, signal);
    usleep(1000);
    kill(child, SIGTERM);  // of somebody else
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 5);
    EXPECT_EQ(json_of(folder.path / name / "summary.json")["end"], "stopped");
    ASSERT_EQ(traceraft("resume --quiet " + out(name)).code, 0);
    expect_same_results("whole", name);
  }
}

// They write nothing before they are done, and do not finish a step of theirs first.
TEST_F(ProgramTest, StopsStudiesAndGeneratorsAtOnceWhenAskedTo) {
  for (const std::string& command :
       {"verify coarsening --threads 1 --out " + out("studies"),
        "hide --effects uptake --epsilon 0.5 --out " + out("hidden")}) {
    const pid_t child = testing::start_traceraft(command + " > /dev/null");
    sleep(2);
    ASSERT_EQ(waitpid(child, nullptr, WNOHANG), 0) << command;
    const auto asked = std::chrono::steady_clock::now();
    kill(child, SIGTERM);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status)) << command;
    EXPECT_EQ(WEXITSTATUS(status), 5) << command;
    EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::seconds(20)) << command;
  }
}

TEST_F(ProgramTest, RefusesADamagedCheckpointAndUsesTheOneBefore) {
  ASSERT_EQ(traceraft("run --quiet " + quick + "--out " + out("whole")).code, 0);
  const pid_t child = start("a");
  wait_for_rows("a", 12);
  kill_running(child);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder.path / "a/checkpoints"))
    if (entry.path().extension() == ".ckpt") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_GE(files.size(), 2u);
  ASSERT_LE(files.size(), 3u);  // if killed before the oldest was removed
  std::string data = content(files.back());
  data[data.size() / 2] ^= 1;
  posix::write_durably(files.back(), data);
  const ProgramEnd resumed = traceraft("resume --quiet " + out("a"));
  EXPECT_EQ(resumed.code, 0);
  EXPECT_TRUE(names(resumed.output, files.back().string()));
  expect_same_results("whole", "a");
}

TEST_F(ProgramTest, RefusesAllDamagedCheckpoints) {
  ASSERT_EQ(traceraft("run --quiet " + quick + "--out " + out("a")).code, 0);
  for (const auto& entry : fs::directory_iterator(folder.path / "a/checkpoints"))
    posix::write_durably(entry.path(), "rubbish");
  EXPECT_EQ(traceraft("resume " + out("a")).code, 4);
}

TEST_F(ProgramTest, LocksItsFolder) {
  const pid_t child = start("a");
  wait_for_rows("a", 3);
  EXPECT_EQ(traceraft("resume " + out("a")).code, 6);
  EXPECT_EQ(traceraft("run " + quick + "--out " + out("a")).code, 6);
  kill_running(child);
  const ProgramEnd again = traceraft("run " + quick + "--out " + out("a"));
  EXPECT_TRUE(refuses(again, "traceraft resume"));
}

TEST_F(ProgramTest, LeavesForeignFilesAlone) {
  fs::create_directories(folder.path / "a/checkpoints-of-mine");
  fs::create_directories(folder.path / "mine");
  posix::write_durably(folder.path / "a/notes.txt", "mine");
  posix::write_durably(folder.path / "mine/view.png", "mine");
  EXPECT_EQ(traceraft("run --quiet " + quick + "--out " + out("mine")).code, 2);
  EXPECT_EQ(content(folder.path / "mine/view.png"), "mine");
  // Folders of other commands are no place for a run.
  fs::create_directories(folder.path / "measured");
  posix::write_durably(folder.path / "measured/dataset.toml", "mine");
  const ProgramEnd beside = traceraft("run --quiet " + quick + "--out " + out("measured"));
  EXPECT_TRUE(refuses(beside, "dataset.toml"));
  EXPECT_FALSE(fs::exists(folder.path / "measured/config.toml"));
  const ProgramEnd foreign = traceraft("run --quiet " + quick + "--out " + out("a"));
  EXPECT_TRUE(refuses(foreign, out("a")));
  EXPECT_FALSE(fs::exists(folder.path / "a/config.toml"));
  EXPECT_EQ(content(folder.path / "a/notes.txt"), "mine");
  EXPECT_TRUE(fs::exists(folder.path / "a/checkpoints-of-mine"));
}

TEST_F(ProgramTest, LeavesNothingInAFolderThatItRefuses) {
  fs::create_directories(folder.path / "a");
  posix::write_durably(folder.path / "a/notes.txt", "mine");
  for (const std::string& command :
       {"run " + quick, "compare " + quick, std::string("ensemble --runs 3 "),
        std::string("verify conservation "), std::string("hide --effects none ")}) {
    EXPECT_EQ(traceraft(command + "--out " + out("a")).code, 2) << command;
    for (const auto& entry : fs::directory_iterator(folder.path / "a"))
      EXPECT_EQ(entry.path().filename(), "notes.txt") << command;
  }
}

TEST_F(ProgramTest, AFullDiskIsAnInputOutputErrorAndKeepsTheOldCheckpoint) {
  // A limit on file sizes (in blocks of 512 bytes), reached by the growing table in mid-run.
  const ProgramEnd run = shell("ulimit -f 100; exec " + std::string(TRACERAFT_PROGRAM) +
                               " run --quiet --checkpoint-interval 0 --no-fields --case two-rafts "
                               "--cells 8 --epsilon 1.5 --mobility constant:value=0.01 "
                               "--integrator euler --tolerance 1e-5 --out " +
                               out("a"));
  ASSERT_EQ(run.code, 4) << run.output;
  EXPECT_TRUE(names(run.output, "series.csv"));
  // The run goes on when there is room again, as if nothing had happened.
  const ProgramEnd resumed = traceraft("resume --quiet " + out("a"));
  EXPECT_EQ(resumed.code, 0) << resumed.output;
  ASSERT_EQ(traceraft("run --quiet --no-fields --case two-rafts --cells 8 --epsilon 1.5 "
                      "--mobility constant:value=0.01 --integrator euler --tolerance 1e-5 --out " +
                      out("whole"))
                .code,
            0);
  expect_same_results("whole", "a");
}

TEST_F(ProgramTest, NumericalFailureExitsWithThree) {
  const ProgramEnd run =
      traceraft("run " + quick + "--tolerance 1e-9 --min-step 0.01 --out " + out("a"));
  EXPECT_EQ(run.code, 3);
  const auto summary = json_of(folder.path / "a/summary.json");
  EXPECT_EQ(summary["end"], "failed");
  EXPECT_TRUE(names(run.output, summary["why"]));
}

TEST_F(ProgramTest, RestartsFromAnotherRun) {
  ASSERT_EQ(traceraft("run --quiet " + quick + "--out " + out("a")).code, 0);
  const std::string same_mesh = "run --quiet --case two-rafts --epsilon 0.8 --t-end 0.01 ";
  const ProgramEnd next =
      traceraft(same_mesh + "--cells 16 --initial restart:" + out("a") + " --out " + out("b"));
  ASSERT_EQ(next.code, 0) << next.output;
  const auto first = json_of(folder.path / "a/summary.json");
  const auto second = json_of(folder.path / "b/summary.json");
  EXPECT_NEAR(second["mass"].get<double>() / first["mass"].get<double>(), 1, 1e-12);
  // The new run does not need the old one any more.
  fs::rename(folder.path / "a", folder.path / "moved");
  EXPECT_EQ(traceraft("resume --quiet " + out("b")).code, 0);
}

// As fine as these meshes are, a raft has the same length and energy on both, and on one that
// follows its boundary.
TEST_F(ProgramTest, RestartsOnAnotherMesh) {
  const std::string raft = "run --quiet --scaled --epsilon 0.08 --initial caps --no-fields ";
  ASSERT_EQ(
      traceraft(raft + "--initial-caps '0 0 1 50' --cells 64 --t-end 1 --out " + out("a")).code, 0);
  const auto first = json_of(folder.path / "a/summary.json");
  const auto restart = [&](const std::string& mesh, const std::string& from,
                           const std::string& to) {
    const ProgramEnd next =
        traceraft("run --quiet --scaled --epsilon 0.08 --no-fields --t-end 1e-6 " + mesh +
                  " --initial restart:" + out(from) + " --out " + out(to));
    EXPECT_EQ(next.code, 0) << next.output;
    const auto summary = json_of(folder.path / to / "summary.json");
    EXPECT_NEAR(summary["mass"].get<double>() / first["mass"].get<double>(), 1, 1e-12);
    for (const char* number : {"energy", "perimeter", "raft_fraction"})
      EXPECT_NEAR(summary[number].get<double>() / first[number].get<double>(), 1, 5e-3) << number;
    return summary;
  };
  restart("--cells 48", "a", "b");
  const auto adaptive = restart("--cells 64 --mesh adaptive", "a", "c");
  EXPECT_LT(adaptive["nodes"], first["nodes"]);
  restart("--cells 64", "c", "d");
  EXPECT_EQ(traceraft("run --surface ellipsoid --cells 64 --initial restart:" + out("a") +
                      " --out " + out("e"))
                .code,
            2);
}

// Everything is valid, and nothing can separate: of the usual well on a sphere that is where
// epsilon > R/√8, in units of R.
TEST_F(ProgramTest, SaysThatBoundariesAreAsWideAsTheVesicle) {
  // R/√8; with a well that is 25 times as deep, five times as much; and a torus is longer than
  // that, R/2.
  for (const auto& [model, wide] :
       {std::pair("0.36", true), std::pair("0.35", false), std::pair("1.75 --well rho=6.25", false),
        std::pair("1.78 --well rho=6.25", true), std::pair("0.4 --surface torus", false),
        std::pair("0.51 --surface torus", true),
        std::pair("2.45 --surface torus --well rho=6.25", false),
        std::pair("2.55 --surface torus --well rho=6.25", true)}) {
    const ProgramEnd run = traceraft(
        std::string("run --validate --scaled --case two-rafts --cells 16 --epsilon ") + model);
    EXPECT_EQ(run.code, 0) << run.output;
    EXPECT_EQ(names(run.output, "TOO WIDE FOR THE VESICLE"), wide) << run.output;
  }
}

TEST_F(ProgramTest, ValidateStopsAfterChecking) {
  const ProgramEnd run = traceraft("run --validate " + quick + "--out " + out("new"));
  EXPECT_EQ(run.code, 0) << run.output;
  EXPECT_FALSE(fs::exists(folder.path / "new"));
}

TEST_F(ProgramTest, ValidatesWithoutAWordIfItIsToBeQuiet) {
  const ProgramEnd run = traceraft("run --validate --quiet " + quick);
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.output, "");
}

TEST_F(ProgramTest, HelpAndListNameEverything) {
  const std::string help = traceraft("run --help").output, list = traceraft("list").output;
  for (const char* word : {"--case", "--epsilon", "--linear-solver", "--scaled"})
    EXPECT_TRUE(names(help, word));
  for (const char* word : {"guv-3to1", "biconcave", "degenerate", "euler", "block", "direct"})
    EXPECT_TRUE(names(list, word));
  EXPECT_EQ(traceraft("--version").code, 0);
}

TEST(FractionCommand, SaysWhatToSimulate) {
  const ProgramEnd known = traceraft("fraction --composition 2:1:20% --temperature 19.2");
  EXPECT_EQ(known.code, 0) << known.output;
  EXPECT_TRUE(names(known.output, "run --case guv-2to1 --raft-fraction 0.156"));
  const ProgramEnd given = traceraft(
      "fraction --composition 3:1:20 --temperature 15 --ordered 22:43:35 --disordered 66:16:18");
  EXPECT_TRUE(names(given.output, "run --case guv-3to1 --raft-fraction 0.108"));
  for (const char* wrong :
       {"", "--composition 3:1", "--composition 1:1:20", "--composition 2:1:20 --temperature 99",
        "--composition 2:1:20 --ordered 22:43:35"}) {
    const ProgramEnd refused = traceraft(std::string("fraction ") + wrong);
    EXPECT_EQ(refused.code, 2) << wrong << refused.output;
    EXPECT_EQ(std::count(refused.output.begin(), refused.output.end(), '\n'), 1) << refused.output;
  }
}

}  // namespace
}  // namespace traceraft
