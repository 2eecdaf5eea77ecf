// Situations that users of similar programs got into, tried on this one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "drivers/input/csv_table.hpp"
#include "kernel/core/types.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::ProgramEnd;
using testing::TemporaryFolder;
using testing::traceraft;

class SituationsTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  const std::string quick = "--case two-rafts --cells 16 --epsilon 0.8 --no-fields ";
  std::string out(const std::string& name) const { return (folder.path / name).string(); }
  nlohmann::json summary(const std::string& name) const {
    return testing::json_of(folder.path / name / "summary.json");
  }
  input::CsvTable table(const std::string& name, const char* file) const {
    return input::CsvTable::read(folder.path / name / file);
  }
};

TEST_F(SituationsTest, OutputTimesAreTakenAsPeopleTypeThem) {
  const ProgramEnd run = traceraft("run " + quick +
                                   "--t-end 100 --output-times 100,20,9 --output-times 1e1,10 "
                                   "--out " +
                                   out("a"));
  ASSERT_EQ(run.code, 0) << run.output;
  EXPECT_TRUE(testing::names(run.output, ": 10\n"));  // was given more than once
  EXPECT_EQ(table("a", "observables.csv").numbers("t"), (std::vector<double>{9, 10, 20, 100}));
}

// An end that comes at once, a first step beyond it, an initial state far outside of the phases.
TEST_F(SituationsTest, FirstStepsEndWellWithEveryIntegrator) {
  int number = 0;
  for (const char* integrator : {"ida", "euler", "rosenbrock"})
    for (const char* options : {"--t-end 1e-99 --scaled --epsilon 0.16", "--t-end 1e-12",
                                "--t-end 1 --initial-step 1e6"}) {
      const std::string name = std::to_string(++number);
      const ProgramEnd run = traceraft(
          "run --quiet --case two-rafts --cells 16 --no-fields --integrator " +
          std::string(integrator) + " " + options +
          (std::string(options).find("epsilon") == std::string::npos ? " --epsilon 0.8" : "") +
          " --out " + out(name));
      EXPECT_EQ(run.code, 0) << integrator << " " << options << run.output;
      EXPECT_LE(summary(name)["mass_drift"].get<double>(), 1e-12);
    }
}

TEST_F(SituationsTest, AnInitialStateFarOutsideOfThePhasesComesIn) {
  for (const std::string integrator : {"ida", "euler", "rosenbrock"}) {
    const ProgramEnd run = traceraft("run --quiet " + quick +
                                     "--t-end 1 --initial formula --initial-formula '3*x' "
                                     "--integrator " +
                                     integrator + " --out " + out(integrator));
    ASSERT_EQ(run.code, 0) << run.output;
    EXPECT_LE(summary(integrator)["mass_drift"].get<double>(), 1e-12);
    EXPECT_LT(summary(integrator)["c_max"].get<double>(), 2);
  }
}

// Where most of the membrane is raft, what is not makes the domains.
TEST_F(SituationsTest, TheMinorityOfAnOrderedMembraneIsCounted) {
  const ProgramEnd run = traceraft(
      "run --case two-rafts --cells 16 --epsilon 0.4 --t-end 1e-3 --output-times 0 --no-fields "
      "--initial formula --initial-formula '0.75-0.7*x*y*z/0.19' --out " +
      out("a"));
  ASSERT_EQ(run.code, 0) << run.output;
  const input::CsvTable row = table("a", "observables.csv");
  EXPECT_GT(row.number(0, "raft_fraction"), 0.5);
  EXPECT_EQ(row.number(0, "rafts"), 1);
  EXPECT_EQ(row.number(0, "domains"), 4);
  EXPECT_TRUE(testing::names(run.output, " 4 domains"));
  EXPECT_EQ(summary("a")["domains"], 4);
}

// The guide prints the raft fractions that the program answers.
TEST(GuideTest, RaftFractionsAreThoseOfTheProgram) {
  std::istringstream guide(testing::content(TRACERAFT_ROOT "/docs/guide.md"));
  int rows = 0;
  for (std::string line; std::getline(guide, line);) {
    // | 3:1:20 | 15 °C | 10.8 % | 10.8 % | |
    std::istringstream words(line);
    std::string bar, membrane, celsius, degree, published, percent, own;
    words >> bar >> membrane >> bar >> celsius >> degree >> bar >> published >> percent >> bar >>
        own;
    if (degree != "°C" || std::count(membrane.begin(), membrane.end(), ':') != 2) continue;
    ++rows;
    const ProgramEnd answer =
        traceraft("fraction --composition " + membrane + " --temperature " + celsius);
    EXPECT_EQ(answer.code, 0) << answer.output;
    EXPECT_TRUE(testing::names(answer.output, own + " %")) << line;
  }
  EXPECT_EQ(rows, 4);
}

// The membrane turns as a whole: after a turn everything is where it was.
TEST_F(SituationsTest, AdvectionKeepsMassAndComesBackAfterATurn) {
  const ProgramEnd run = traceraft(
      "run --quiet --scaled --case two-rafts --cells 16 --epsilon 0.16 --no-fields --t-end 3 "
      "--initial caps --initial-caps '1 0 0.3 60' --output-times 1,1.5,2,3 "
      "--effect rotation:rate=6.283185307179586 --out " +
      out("a"));
  ASSERT_EQ(run.code, 0) << run.output;
  EXPECT_LE(summary("a")["mass_drift"].get<double>(), 1e-12);
  const input::CsvTable rafts = table("a", "rafts.csv");
  ASSERT_EQ(rafts.rows(), 4u);
  const auto centre = [&](std::size_t k) {
    return Point(rafts.number(k, "x"), rafts.number(k, "y"), rafts.number(k, "z"));
  };
  EXPECT_LT((centre(2) - centre(0)).norm(), 0.05);
  EXPECT_LT((centre(3) - centre(0)).norm(), 0.05);
  EXPECT_LT(centre(1)[0], -0.5 * centre(0)[0]) << "half a turn later it is on the other side";
}

}  // namespace
}  // namespace traceraft
