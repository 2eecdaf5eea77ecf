// The program under mpirun as a user meets it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "backends/zlib/vtu_reader.hpp"
#include "drivers/input/csv_table.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::content;
using testing::ProgramEnd;
using testing::shell;
using testing::TemporaryFolder;
namespace fs = std::filesystem;

// Ranks share two processors: they give way to each other while they wait.
const std::string kEnvironment = "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 ";
const std::string kMpirun =
    TRACERAFT_MPIRUN " --quiet --oversubscribe --mca mpi_yield_when_idle 1 --timeout 200 ";

class RanksTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  std::string at(const std::string& name) const { return (folder.path / name).string(); }
  static ProgramEnd on(int ranks, const std::string& arguments) {
    return shell(kEnvironment + kMpirun + "-np " + std::to_string(ranks) +
                 " " TRACERAFT_PROGRAM " " + arguments);
  }
  // mpirun, in the background.
  static pid_t start(int ranks, const std::string& arguments) {
    const pid_t child = fork();
    if (child == 0) {
      const std::string command = kEnvironment + "exec " + kMpirun + "-np " +
                                  std::to_string(ranks) + " " TRACERAFT_PROGRAM " " + arguments;
      execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    return child;
  }
  void while_short_of(long lines, const std::string& name) const {
    for (int i = 0; i < 6000 && testing::lines_of(at(name) + "/series.csv") < lines; ++i)
      usleep(10000);
  }
  // The process that this mpirun has started as a rank; 0 if there is none.
  static pid_t rank_below(pid_t mpirun, int rank) {
    const std::string variable = "OMPI_COMM_WORLD_RANK=" + std::to_string(rank);
    std::ifstream children("/proc/" + std::to_string(mpirun) + "/task/" + std::to_string(mpirun) +
                           "/children");
    for (pid_t child = 0; children >> child;) {
      std::ifstream environment("/proc/" + std::to_string(child) + "/environ");
      for (std::string entry; std::getline(environment, entry, '\0');)
        if (entry == variable) return child;
    }
    return 0;
  }
  // Runs until there are some steps, and asks all ranks to stop, as mpirun passes on this signal.
  void stop_early(int ranks, const std::string& arguments, const std::string& name) const {
    const pid_t child = start(ranks, arguments);
    while_short_of(8, name);
    kill(child, SIGUSR1);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 5);
  }
  nlohmann::json summary(const std::string& name) const {
    return nlohmann::json::parse(content(at(name) + "/summary.json"));
  }
  const std::string runs =
      "--case two-rafts --cells 16 --epsilon 0.8 --t-end 1 --linear-solver teko ";
};

TEST_F(RanksTest, ARunOnRanksIsTheRunOfOne) {
  ASSERT_EQ(testing::traceraft("run --quiet " + runs + "--out " + at("one")).code, 0);
  const ProgramEnd two = on(2, "run " + runs + "--out " + at("two"));
  ASSERT_EQ(two.code, 0) << two.output;
  EXPECT_TRUE(testing::names(two.output, "2 ranks"));
  const std::size_t said = two.output.find("finished at t");
  EXPECT_NE(said, std::string::npos);
  EXPECT_EQ(two.output.rfind("finished at t"), said) << "said by more than one rank";
  const auto one = summary("one"), many = summary("two");
  for (const char* same : {"nodes", "unknowns", "cut_tetrahedra", "euler_characteristic", "rafts"})
    EXPECT_EQ(one.at(same), many.at(same)) << same;
  for (const char* close : {"energy", "perimeter", "mass", "raft_fraction", "c_max"})
    EXPECT_NEAR(many.at(close).get<double>() / one.at(close).get<double>(), 1, 1e-3) << close;
  EXPECT_EQ(many.at("ranks"), 2);
  EXPECT_LE(many.at("mass_drift").get<double>(), 1e-12);
  // Memory is that of all ranks: most of it is the program, which every one of them has.
  EXPECT_GT(many.at("peak_memory_mb").get<double>(), 1.5 * one.at("peak_memory_mb").get<double>());
  // Every rank has written its piece of the fields, and one file joins them.
  EXPECT_TRUE(fs::exists(at("two") + "/fields/field-0000-0001.vtu"));
  EXPECT_TRUE(testing::names(content(at("two") + "/fields.pvd"), "field-0000.pvtu"));
  EXPECT_TRUE(fs::exists(at("two") + "/view.png"));
}

TEST_F(RanksTest, GoesOnWithMoreAndFewerRanks) {
  const ProgramEnd whole = on(2, "run --quiet " + runs + "--out " + at("whole"));
  ASSERT_EQ(whole.code, 0) << whole.output;
  for (const int ranks : {1, 3}) {
    const std::string name = "part" + std::to_string(ranks);
    stop_early(2, "run --quiet --checkpoint-interval 0 " + runs + "--out " + at(name), name);
    EXPECT_EQ(summary(name).at("end"), "stopped");
    const ProgramEnd resumed = on(ranks, "resume --quiet " + at(name));
    ASSERT_EQ(resumed.code, 0) << resumed.output;
    EXPECT_EQ(summary(name).at("end"), "finished");
    EXPECT_EQ(summary(name).at("ranks"), ranks);
    for (const char* close : {"energy", "perimeter", "mass"})
      EXPECT_NEAR(summary(name).at(close).get<double>() / summary("whole").at(close).get<double>(),
                  1, 1e-3)
          << close << " on " << ranks;
  }
}

// A batch system may reach one of the processes only.
TEST_F(RanksTest, StopWhereOneOfThemIsAskedTo) {
  const pid_t mpirun = start(2, "run --quiet " + runs + "--out " + at("run"));
  while_short_of(8, "run");
  const pid_t second = rank_below(mpirun, 1);
  ASSERT_GT(second, 0);
  kill(second, SIGTERM);
  int status = 0;
  waitpid(mpirun, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 5);
  EXPECT_EQ(summary("run").at("end"), "stopped");
  EXPECT_EQ(on(2, "resume --quiet " + at("run")).code, 0);
}

// Fields that a run wrote after its last checkpoint are written again, by as many ranks as there
// are then; a run that had two threads goes on with ranks.
TEST_F(RanksTest, FieldsAreThoseOfTheLastWriter) {
  const pid_t child = testing::start_traceraft(
      "run --quiet --threads 2 --output-times 0,0.001,1 --checkpoint-interval 1000 " + runs +
      "--out " + at("run"));
  const std::string fields = at("run") + "/fields/";
  for (int i = 0; i < 6000 && !fs::exists(fields + "field-0001.vtu"); ++i) usleep(10000);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  ASSERT_TRUE(fs::exists(fields + "field-0001.vtu"));
  ASSERT_FALSE(fs::exists(at("run") + "/summary.json"));
  const ProgramEnd resumed = on(2, "resume --quiet " + at("run"));
  ASSERT_EQ(resumed.code, 0) << resumed.output;
  EXPECT_FALSE(fs::exists(fields + "field-0001.vtu"));
  for (const char* name : {"field-0001.pvtu", "field-0001-0000.vtu", "field-0001-0001.vtu"})
    EXPECT_TRUE(fs::exists(fields + name)) << name;
}

// Fields of all pieces at the n-th output time: raft numbers of the triangles by their midpoints.
std::map<std::array<long, 3>, int> raft_numbers(const fs::path& run, const std::string& file) {
  std::vector<std::string> names = {file};
  if (file.substr(file.rfind('.')) == ".pvtu") names = zlib::pieces_of_pvtu(content(run / file));
  std::map<std::array<long, 3>, int> numbers;
  for (const std::string& name : names) {
    const std::string text = content((run / file).parent_path() / fs::path(name).filename());
    const observables::SurfaceMesh mesh = zlib::read_vtu(text, "c").mesh;
    const std::vector<int> rafts = zlib::read_cells(text, "raft");
    EXPECT_EQ(rafts.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < rafts.size(); ++t) {
      Point middle = Point::Zero();
      for (const int p : mesh.triangles[t]) middle += mesh.position[p] / 3;
      std::array<long, 3> key;
      for (int axis = 0; axis < 3; ++axis) key[axis] = std::lround(1e4 * middle[axis]);
      numbers[key] = rafts[t];
    }
  }
  return numbers;
}

// One spiral over all ranks is one raft, three are three; ParaView counts them by their numbers.
TEST_F(RanksTest, SpiralsOverAllRanksAreCountedOnce) {
  for (const int arms : {1, 3}) {
    const std::string spiral =
        "run --quiet --case two-rafts --cells 24 --epsilon 0.8 --t-end 1e-6 --output-times 0 "
        "--linear-solver teko --initial formula --initial-formula "
        "'0.4+0.45*sqrt((x^2+y^2)/(x^2+y^2+z^2))*sin(4*acos(z/sqrt("
        "x^2+y^2+z^2))+" +
        std::to_string(arms) + "*atan2(y,x))' --out ";
    double perimeter = 0;
    std::map<std::array<long, 3>, int> expected;
    for (const int ranks : {1, 2, 3, 5}) {
      const std::string name = std::to_string(arms) + "-" + std::to_string(ranks);
      const ProgramEnd end = on(ranks, spiral + at(name));
      ASSERT_EQ(end.code, 0) << end.output;
      const input::CsvTable row = input::CsvTable::read(at(name) + "/observables.csv");
      EXPECT_EQ(row.number(0, "rafts"), arms);
      const double length = row.number(0, "perimeter_level");
      if (ranks == 1) perimeter = length;
      EXPECT_NEAR(length / perimeter, 1, 1e-12);
      const auto files = zlib::files_of_pvd(content(at(name) + "/fields.pvd"));
      ASSERT_EQ(files.size(), 1u);
      const auto numbers = raft_numbers(at(name), files[0].second);
      int most = 0;
      for (const auto& [place, number] : numbers) most = std::max(most, number);
      EXPECT_EQ(most, arms);
      if (ranks == 1) expected = numbers;
      EXPECT_EQ(numbers, expected) << ranks;
    }
  }
}

// However often it was interrupted, and on however many ranks it went on.
TEST_F(RanksTest, EveryTimeIsCollectedOnce) {
  const std::string name = "run";
  std::string command = "run --quiet --checkpoint-interval 0 " + runs + "--out " + at(name);
  long rows = 8;
  for (const int ranks : {2, 1, 3}) {
    const pid_t child = start(ranks, command);
    while_short_of(rows, name);
    kill(child, SIGUSR1);
    waitpid(child, nullptr, 0);
    rows = testing::lines_of(at(name) + "/series.csv") + 8;
    command = "resume --quiet --checkpoint-interval 0 " + at(name);
  }
  const ProgramEnd last = on(2, "resume --quiet " + at(name));
  ASSERT_EQ(last.code, 0) << last.output;
  const auto files = zlib::files_of_pvd(content(at(name) + "/fields.pvd"));
  const input::CsvTable observables = input::CsvTable::read(at(name) + "/observables.csv");
  ASSERT_EQ(files.size(), observables.rows());
  for (std::size_t k = 0; k < files.size(); ++k) {
    EXPECT_EQ(files[k].first, observables.number(k, "t"));
    EXPECT_TRUE(k == 0 || files[k].first > files[k - 1].first);
    ASSERT_TRUE(fs::exists(at(name) + "/" + files[k].second)) << files[k].second;
    EXPECT_FALSE(raft_numbers(at(name), files[k].second).empty());
  }
}

// Runs that end before they compute may share the processors with other tests.
using RanksEndTest = RanksTest;

TEST_F(RanksEndTest, TheFirstRankSpeaksForAll) {
  fs::create_directories(at("taken") + "/fields");
  const ProgramEnd taken = on(2, "run " + runs + "--out " + at("taken"));
  EXPECT_EQ(taken.code, 2);
  // Before or after the heading: mpirun passes on two streams, in any order.
  EXPECT_NE(("\n" + taken.output).find("\ntraceraft: --out: "), std::string::npos) << taken.output;
  const ProgramEnd missing = on(2, "resume " + at("nothing"));
  EXPECT_TRUE(testing::refuses(missing, at("nothing")));
  EXPECT_EQ(std::count(missing.output.begin(), missing.output.end(), '\n'), 1) << missing.output;
  const ProgramEnd compare = on(1, "compare --case two-rafts --ranks 1,2");
  EXPECT_EQ(compare.code, 2);
  EXPECT_TRUE(testing::names(compare.output, "mpirun"));
}

TEST_F(RanksEndTest, SaysWhatIsWrongOnce) {
  const ProgramEnd flag = on(3, "run --cels 7");
  EXPECT_TRUE(testing::refuses(flag, "'--cells'"));
  EXPECT_EQ(std::count(flag.output.begin(), flag.output.end(), '\n'), 1) << flag.output;
  const ProgramEnd solver = on(2, "run --case two-rafts --cells 12 --linear-solver block");
  EXPECT_EQ(solver.code, 2);
  EXPECT_TRUE(testing::names(solver.output, "--linear-solver"));
  const ProgramEnd threads = on(2, "run " + runs + "--threads 2");
  EXPECT_EQ(threads.code, 2);
  EXPECT_TRUE(testing::names(threads.output, "--threads"));
  const ProgramEnd verify = on(2, "verify mass --quick");
  EXPECT_EQ(verify.code, 2);
  EXPECT_TRUE(testing::names(verify.output, "mpirun"));
}

TEST_F(RanksTest, AreAnAxisOfComparisons) {
  const ProgramEnd outcome = shell(
      kEnvironment + TRACERAFT_PROGRAM " compare --out " + at("c") + " --references " + at("r") +
      " --case two-rafts --cells 12 --epsilon 1 --t-end 0.1 --integrators ida --tolerances 1e-2 "
      "--threads 2 "  // ranks have one each
      "--linear-solvers block,teko --ranks 1,2 --repeat 1");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_TRUE(testing::names(outcome.output, "ida with teko"));
  for (const auto& [job, ranks] :
       {std::pair("ida-block-0.01-1", 1), std::pair("ida-teko-0.01-1", 1),
        std::pair("ida-teko-2ranks-0.01-1", 2)})
    EXPECT_EQ(summary(std::string("c/runs/") + job).at("ranks"), ranks) << job;
  EXPECT_EQ(testing::lines_of(at("c") + "/compare.csv"), 4);  // block does not work on two
}

// The solver of MPI has worked in the very process that starts the ranks.
TEST_F(RanksTest, AreMeasuredByVerifications) {
  const ProgramEnd outcome =
      shell(kEnvironment +
            TRACERAFT_PROGRAM
            " verify agreement --quick --linear-solver teko --integrator ida "
            "--out " +
            at("v"));
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_EQ(testing::lines_of(at("v") + "/agreement-ranks.csv"), 2);
  EXPECT_FALSE(fs::exists(at("v") + "/ranks"));
}

TEST_F(RanksTest, OneThatFailsEndsAll) {
  stop_early(2, "run --quiet --checkpoint-interval 0 " + runs + "--out " + at("run"), "run");
  // Where the second rank wants to write its piece of the last field there is a folder already.
  fs::create_directories(at("run") + "/fields/field-0016-0001.vtu");
  const ProgramEnd outcome = on(2, "resume --quiet " + at("run"));
  EXPECT_EQ(outcome.code, 4) << outcome.output;
  EXPECT_TRUE(testing::names(outcome.output, "rank 1"));
  EXPECT_TRUE(testing::names(outcome.output, "field-0016-0001.vtu"));
  // Everything that was there is still there.
  fs::remove(at("run") + "/fields/field-0016-0001.vtu");
  EXPECT_EQ(on(2, "resume --quiet " + at("run")).code, 0);
}

}  // namespace
}  // namespace traceraft
