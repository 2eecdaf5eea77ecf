// The surroundings of a process: descriptors, limits, environment and signals.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::content;
using testing::ProgramEnd;
using testing::shell;
using testing::traceraft;
namespace fs = std::filesystem;

class SurroundingsTest : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder;
  const std::string run = "run --case two-rafts --cells 12 --epsilon 1 --t-end 0.3 --out ";
  const std::string out = (folder.path / "r").string();
};

// Without them the first files that are opened become standard output and error.
TEST_F(SurroundingsTest, ClosedDescriptorsPutNoTextIntoFiles) {
  ASSERT_EQ(traceraft(run + out + " --quiet").code, 0);
  for (const char* closed : {"<&- >&-", "<&- >&- 2>&-", ">&-"}) {
    const std::string other = out + "-closed";
    const ProgramEnd end =
        shell("(exec " + std::string(TRACERAFT_PROGRAM) + " " + run + other + " " + closed + ")");
    EXPECT_EQ(end.code, 4) << closed << ": what it says is lost";
    for (const char* table : {"series.csv", "observables.csv", "rafts.csv", "config.toml"})
      EXPECT_EQ(content(fs::path(other) / table), content(fs::path(out) / table)) << table;
    fs::remove_all(other);
  }
  const ProgramEnd quiet = shell("(exec " + std::string(TRACERAFT_PROGRAM) + " " + run + out +
                                 "-quiet --quiet <&- >&-)");
  EXPECT_EQ(quiet.code, 0) << quiet.output;
}

// Opening the reading end of a pipe waits for a writer, and there is none.
TEST_F(SurroundingsTest, PipesInThePlaceOfFilesAreNotWaitedFor) {
  ASSERT_EQ(traceraft(run + out + " --quiet").code, 0);
  for (const char* name : {"series.csv", "config.toml", "summary.json"})
    for (const char* command : {"resume", "report"}) {
      const fs::path file = fs::path(out) / name;
      const std::string whole = content(file);
      fs::remove(file);
      const ProgramEnd end =
          shell("mkfifo " + file.string() + " && timeout 20 " TRACERAFT_PROGRAM " " + command +
                " " + out + " --quiet");
      // resume writes a new summary in its place.
      const bool replaced = std::string(name) == "summary.json" && std::string(command) == "resume";
      EXPECT_TRUE(end.code == (replaced ? 0 : 4) || end.code == (replaced ? 0 : 2))
          << command << " " << name << ": " << end.code;
      fs::remove(file);
      std::ofstream(file) << whole;
    }
}

TEST_F(SurroundingsTest, OutputThatCannotBeWrittenIsAnError) {
  for (const char* command : {"list", "--help", "run --help", "--version",
                              "fraction --composition "
                              "2:1:20 --temperature 20"}) {
    const ProgramEnd end =
        shell("(exec " + std::string(TRACERAFT_PROGRAM) + " " + command + " 2>&1 >/dev/full)");
    EXPECT_EQ(end.code, 4) << command;
    EXPECT_NE(end.output.find("No space left"), std::string::npos) << end.output;
  }
}

TEST_F(SurroundingsTest, LimitsOfFilesAndMemoryEndWithAReason) {
  const ProgramEnd small =
      shell("ulimit -f 8; exec " + std::string(TRACERAFT_PROGRAM) + " " + run + out);
  EXPECT_EQ(small.code, 4) << small.output;
  EXPECT_NE(small.output.find("File too large"), std::string::npos) << small.output;
#if !defined(__SANITIZE_ADDRESS__)
  // Below that the loader itself refuses (127), beyond that there is enough.
  int told = 0;
  for (const char* kilobytes : {"150000", "200000", "250000", "300000", "350000"}) {
    const ProgramEnd end = shell("ulimit -v " + std::string(kilobytes) + "; exec timeout 20 " +
                                 TRACERAFT_PROGRAM + " list");
    EXPECT_TRUE(end.code == 127 || end.code == 70 || end.code == 0) << kilobytes << end.output;
    told += end.code == 70 && end.output.find("ulimit -v") != std::string::npos;
  }
  EXPECT_GT(told, 0);
#endif
}

TEST_F(SurroundingsTest, AnEmptyEnvironmentIsEnough) {
  const ProgramEnd end = shell("env -i " + std::string(TRACERAFT_PROGRAM) + " " + run + out +
                               " --quiet && env -i " + TRACERAFT_PROGRAM + " report " + out);
  EXPECT_EQ(end.code, 0) << end.output;
  const ProgramEnd ensemble =
      shell("env -i " + std::string(TRACERAFT_PROGRAM) +
            " ensemble --quiet --runs 1 --case spinodal --cells 12 --t-end 0.01 --out " + out +
            "-ensemble");
  EXPECT_EQ(ensemble.code, 0) << ensemble.output;
}

pid_t start_long_run(const std::string& out, const std::string& before) {
  const pid_t child = fork();
  if (child == 0) {
    const std::string command = before + "exec " + std::string(TRACERAFT_PROGRAM) +
                                " run --case spinodal --cells 40 --quiet --no-fields "
                                "--checkpoint-interval 1e9 --out " +
                                out;
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  for (int i = 0; i < 3000 && testing::lines_of(out + "/series.csv") < 4; ++i) usleep(10000);
  return child;
}

TEST_F(SurroundingsTest, AHangUpIsARequestToStop) {
  const pid_t child = start_long_run(out, "");
  kill(child, SIGHUP);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status)) << "it died of signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 5);
  EXPECT_EQ(nlohmann::json::parse(content(out + "/summary.json")).at("end"), "stopped");
}

TEST_F(SurroundingsTest, AHangUpThatIsIgnoredStaysIgnored) {
  const pid_t child = start_long_run(out, "trap '' HUP; ");
  kill(child, SIGHUP);
  const long rows = testing::lines_of(out + "/series.csv");
  for (int i = 0; i < 3000 && testing::lines_of(out + "/series.csv") < rows + 3; ++i) usleep(10000);
  EXPECT_GE(testing::lines_of(out + "/series.csv"), rows + 3) << "it has stopped";
  kill(child, SIGTERM);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 5);
}

// The case is that of `traceraft run | head`.
TEST_F(SurroundingsTest, AnOutputThatNobodyReadsIsARequestToStop) {
  const std::string code = out + ".code";
  (void)shell("(" + std::string(TRACERAFT_PROGRAM) + " run --scaled --cells 16 --epsilon 0.3 " +
              "--t-end 1e9 --max-step 1 --out '" + out + "'; echo $? > '" + code +
              "') | head -n 3");
  EXPECT_EQ(content(code), "5\n");
  EXPECT_EQ(nlohmann::json::parse(content(out + "/summary.json")).at("end"), "stopped");
  EXPECT_FALSE(fs::is_empty(out + "/checkpoints"));
}

TEST_F(SurroundingsTest, MessagesAreShortLines) {
  const std::string longest(100000, 'a');
  for (const std::string& arguments :
       {"'" + longest + "\nb'", "run --case '" + longest + "'", "run --cells " + longest,
        "run --effect '" + longest + ":a=1'", "run --initial-formula '" + longest + "('",
        "run --config '" + longest + "'", "resume '" + longest + "'", "report '" + longest + "'",
        "run --" + longest, longest, "run --out '" + out + "\n'", "verify '" + longest + "'",
        "compare --case spinodal --integrators '" + longest + "'",
        "explain --data '" + longest + "'", "run --surface-formula '" + longest + "'"}) {
    const ProgramEnd end = traceraft(arguments);
    EXPECT_EQ(end.code, 2) << arguments.substr(0, 40) << ": " << end.output.substr(0, 400);
    EXPECT_LE(end.output.size(), 301u) << arguments.substr(0, 40);
    EXPECT_EQ(std::count(end.output.begin(), end.output.end(), '\n'), 1) << arguments.substr(0, 40);
  }
}

}  // namespace
}  // namespace traceraft
