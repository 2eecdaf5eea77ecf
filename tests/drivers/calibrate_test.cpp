// A calibration as a user meets it: from files to files, interrupted, refused. What it finds is
// tested in tests/vesicles/calibration_test.cpp.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "drivers/calibrate/calibration_points.hpp"
#include "drivers/calibrate/calibrator.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;
using testing::content;
using testing::lines_of;
using testing::ProgramEnd;
using testing::TemporaryFolder;
using testing::traceraft;

class CalibrateTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  const std::string model =
      "--case guv-2to1 --cells 16 --epsilon 0.6 --raft-fraction 0.4 --noise-cells 16 ";
  std::string out(const std::string& name) const { return (folder.path / name).string(); }
  void SetUp() override {
    fs::create_directories(folder.path / "data");
    std::ofstream(folder.path / "data/dataset.toml")
        << "name = \"few\"\nkind = \"synthetic\"\ntime_zero = \"start\"\nlength_unit = \"um\"\n"
           "time_unit = \"s\"\nradius = 5\n";
    std::ofstream(folder.path / "data/measurements.csv")
        << "vesicle,time,perimeter,rafts\na,0.01,60,4\na,0.1,45,2\nb,0.02,55,3\nc,0.05,50,3\n"
           "d,0.2,40,2\n";
  }
};

TEST_F(CalibrateTest, GoesFromFilesToFiles) {
  const std::string command =
      "calibrate --data " + out("data") + " " + model + "--runs 2 --out " + out("c");
  const ProgramEnd made = traceraft(command);
  ASSERT_EQ(made.code, 0) << made.output;
  const auto json = nlohmann::json::parse(content(folder.path / "c/calibration.json"));
  EXPECT_EQ(made.output.find("The data determine best") != std::string::npos,
            json["best_known"].is_string());
  if (!json["converged"] || json["mobility_at_bound"]) {
    EXPECT_TRUE(json["best_known"].is_null());
  }
  for (const char* name : {"mobility", "epsilon"}) {
    const auto& parameter = json["parameters"][name];
    EXPECT_LE(parameter["interval_95"][0], parameter["value"].get<double>() * 1.0001) << name;
    EXPECT_TRUE(parameter["determined"].is_boolean());
  }
  // Three stars of three choices at least, and where they did not surround what was found, more.
  const int choices = lines_of(folder.path / "c/calibration.csv") - 1;
  EXPECT_EQ(choices % 3, 0);
  EXPECT_GE(choices, 9);
  EXPECT_LE(choices, 18);
  EXPECT_TRUE(json["converged"] || choices == 18);
  EXPECT_NE(made.output.find("length of the initial noise is that of the model"),
            std::string::npos);
  EXPECT_EQ(made.output.find("NOT CONVERGED") == std::string::npos, json["converged"]);
  // The model that was found can be run.
  const ProgramEnd valid = traceraft("run --validate --config " + out("c/calibrated.toml"));
  EXPECT_EQ(valid.code, 0) << valid.output;
  EXPECT_NE(made.output.find("3 to 6 rounds of simulations; each round has 3 choices"),
            std::string::npos);
  EXPECT_NE(made.output.find("cells, about "), std::string::npos);  // from the second on
  const std::string page = content(folder.path / "c/calibration.html");
  for (const char* words : {"Agreement with the simulations that fit best", "within their range",
                            "Where this comes from"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  // Given again, nothing is simulated again, and the same comes out.
  const std::string before = content(folder.path / "c/calibration.json");
  EXPECT_EQ(traceraft(command + " --quiet").code, 0);
  EXPECT_EQ(content(folder.path / "c/calibration.json"), before);
  // As the page says it is repeated.
  const std::string repeat = "calibrate --data " + out("data") + " --model " +
                             out("c/calibration-model.toml") +
                             " --parameters mobility,epsilon --runs 2 --most-cells 128";
  EXPECT_NE(page.find(repeat), std::string::npos);
  EXPECT_EQ(traceraft(repeat + " --quiet --out " + out("c")).code, 0);
  EXPECT_EQ(content(folder.path / "c/calibration.json"), before);
  const ProgramEnd other = traceraft(command + " --stabilisation 2");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.output.find("holds a calibration of another model"), std::string::npos)
      << other.output;
}

TEST_F(CalibrateTest, GoesOnAfterItWasStopped) {
  const std::string command = "calibrate --quiet --data " + out("data") + " " + model +
                              "--parameters mobility --runs 4 --jobs 1 --out ";
  ASSERT_EQ(traceraft(command + out("whole")).code, 0);
  const pid_t child = testing::start_traceraft(command + out("cut"));
  const fs::path series = folder.path / "cut/points/point/runs/seed-1/series.csv";
  for (int i = 0; i < 6000 && lines_of(series) < 10; ++i) usleep(10000);
  kill(child, SIGTERM);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_EQ(WEXITSTATUS(status), 5);
  ASSERT_EQ(traceraft(command + out("cut")).code, 0);
  EXPECT_EQ(content(folder.path / "cut/calibration.json"),
            content(folder.path / "whole/calibration.json"));
}

// The kept runs of the paper's case know D without simulating, within what is asked of them.
TEST_F(CalibrateTest, FindsTheMobilityOfAnEnsemble) {
  const std::string kept = TRACERAFT_ROOT "/verification/data/";
  const std::string command = "calibrate --data " + kept + "synthetic/guv-2to1 --ensemble " + kept +
                              "ensembles/guv-2to1 --out " + out("c");
  const ProgramEnd made = traceraft(command);
  ASSERT_EQ(made.code, 0) << made.output;
  const auto json = nlohmann::json::parse(content(folder.path / "c/calibration.json"));
  const auto& mobility = json["parameters"]["mobility"];
  EXPECT_EQ(json["parameters"].size(), 1u);
  EXPECT_LT(mobility["interval_95"][0], mobility["value"]);
  EXPECT_GT(mobility["interval_95"][1], mobility["value"]);
  // What fits best is shown with the measurements in it.
  const std::string page = content(folder.path / "c/calibration.html");
  EXPECT_NE(page.find("and the simulations that fit best"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder.path / "c/fit-perimeter.svg"));
  // The data are drawn from a law that was fitted to what simulations with 2.5e-5 cm²/s agree with.
  EXPECT_NEAR(std::log(mobility["value"].get<double>() / 2.5e-5), 0, std::log(2));
  for (const auto& [flags, complaint] :
       {std::pair<std::string, std::string>(" --cells 32", "not allowed with --ensemble"),
        {" --most-cells 64", "--ensemble"},
        {" --parameters mobility,epsilon", "only mobility can be found"},
        {" --model " + out("m.toml"), "not allowed with --ensemble"},
        {" --parameters ''", "--parameters"}}) {
    const ProgramEnd refused = traceraft(command + flags);
    EXPECT_EQ(refused.code, 2) << flags;
    EXPECT_NE(refused.output.find(complaint), std::string::npos) << refused.output;
  }
}

// Vesicles that are larger than the simulated one, and another membrane.
TEST_F(CalibrateTest, DoesNotTakeOneVesicleForAnother) {
  const std::string kept = TRACERAFT_ROOT "/verification/data/";
  const std::string of_runs = " --ensemble " + kept + "ensembles/guv-2to1 --out ";
  const ProgramEnd made =
      traceraft("calibrate --data " + kept + "synthetic/guv-2to1" + of_runs + out("c"));
  ASSERT_EQ(made.code, 0) << made.output;
  const auto json = nlohmann::json::parse(content(folder.path / "c/calibration.json"));
  const auto& mobility = json["parameters"]["mobility"];
  EXPECT_LT(mobility["interval_95"][1], 2 * mobility["interval_95"][0].get<double>());
  EXPECT_EQ(mobility["determined"], false);
  EXPECT_NE(made.output.find("NO: the vesicles have another size"), std::string::npos)
      << made.output;
  EXPECT_NE(made.output.find("D would be 2.8 times as large"), std::string::npos) << made.output;

  const std::string other = "calibrate --data " + kept + "synthetic/guv-3to1";
  for (const std::string& model : {of_runs + out("d"), " --case guv-2to1 --out " + out("d")}) {
    const ProgramEnd refused = traceraft(other + model);
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.output.find("2:1:20 (case guv-2to1), the measurements of 3:1:20"),
              std::string::npos)
        << refused.output;
  }
  const ProgramEnd compared =
      traceraft("data compare " + kept + "synthetic/guv-3to1" + of_runs + out("e"));
  EXPECT_EQ(compared.code, 0);
  EXPECT_NE(compared.output.find("ANOTHER MEMBRANE"), std::string::npos) << compared.output;
}

// What the measurements show after the end of the runs they may have shown before, if D is smaller.
TEST_F(CalibrateTest, LooksForTheMobilityWithinItsRuns) {
  const std::string kept = TRACERAFT_ROOT "/verification/data/";
  fs::create_directories(folder.path / "short");
  fs::copy_file(kept + "ensembles/guv-2to1/config.toml", folder.path / "short/config.toml");
  std::ifstream all(kept + "ensembles/guv-2to1/histories.csv");
  std::ofstream cut(folder.path / "short/histories.csv");
  constexpr double kEnd = 300;  // s; the last look is later
  for (std::string line; std::getline(all, line);) {
    const std::size_t comma = line.find(',');
    if (line[0] == '#') continue;  // the checksum of all rows
    if (line[0] == 's' || std::stod(line.substr(comma + 1)) < kEnd) cut << line << "\n";
  }
  cut.close();
  const ProgramEnd made = traceraft("calibrate --data " + kept + "synthetic/guv-2to1 --ensemble " +
                                    out("short") + " --out " + out("c"));
  ASSERT_EQ(made.code, 0) << made.output;
  const auto json = nlohmann::json::parse(content(folder.path / "c/calibration.json"));
  const auto& mobility = json["parameters"]["mobility"];
  EXPECT_LT(mobility["value"], 2.5e-5);
  EXPECT_EQ(mobility["determined"], false);  // it ends where the runs do
  EXPECT_EQ(mobility["undetermined_because"][0], "D lies at the end of the range searched");
  EXPECT_TRUE(json["best_known"].is_null());
  EXPECT_EQ(json["mobility_at_bound"], true);
  EXPECT_NE(made.output.find("Use an ensemble with a larger --t-end"), std::string::npos);
  for (const char* words : {"The data determine best", "run it with"})
    EXPECT_EQ(made.output.find(words), std::string::npos) << made.output;
  // Another calibration does not take its place, nor anything that is not one.
  const std::string before = content(folder.path / "c/calibration.json");
  for (const auto& [with, to] :
       {std::pair<std::string, std::string>(kept + "ensembles/guv-2to1", "c"),
        {kept + "ensembles/guv-2to1", "short"},
        {out("short"), "c"}}) {
    // The last: of the same runs, but with other data.
    const std::string data = with == out("short") ? out("data") : kept + "synthetic/guv-2to1";
    const ProgramEnd refused =
        traceraft("calibrate --data " + data + " --ensemble " + with + " --out " + out(to));
    EXPECT_EQ(refused.code, 2) << refused.output;
    EXPECT_NE(refused.output.find("choose another folder"), std::string::npos) << refused.output;
  }
  EXPECT_EQ(content(folder.path / "c/calibration.json"), before);
}

// Looks at what has no rafts any more are not evidence, and said to be none.
TEST_F(CalibrateTest, SaysWhatItDoesNotUse) {
  const std::string kept = TRACERAFT_ROOT "/verification/data/ensembles/guv-2to1";
  std::ofstream(folder.path / "data/measurements.csv", std::ios::app) << "e,300,0,0\ne,400,0,0\n";
  const ProgramEnd made =
      traceraft("calibrate --data " + out("data") + " --ensemble " + kept + " --out " + out("c"));
  EXPECT_EQ(made.code, 0) << made.output;
  EXPECT_NE(made.output.find("2 of 7 observations are not used"), std::string::npos) << made.output;
}

// At the ends of its range, too; and it says what was really run, which is whole cells of noise.
TEST(CalibrationPoints, CanBeRun) {
  const Configuration model({}, {{"cells", {"32", "--cells"}}, {"epsilon", {"0.3", "--epsilon"}}});
  for (const char* name : {"epsilon", "fraction", "noise-length"}) {
    const Interval range = range_of(model, name, 48);
    EXPECT_LE(range.low, values_of(model, {name})[0]) << name;
    EXPECT_GE(range.high, values_of(model, {name})[0]) << name;
    for (const double value : {range.low, range.high}) {
      const Configuration there = configuration_at(model, {name}, {value}, 1);
      EXPECT_NEAR(values_of(there, {name})[0] / value, 1, 1e-6) << name;
    }
  }
  const Configuration there = configuration_at(model, {"noise-length"}, {0.7}, 1);
  EXPECT_DOUBLE_EQ(range_of(model, "epsilon", 48).low, 0.2);
  // No finer than allowed, though values are rounded: 0.05 * 128/212 = 0.030189 to 0.03019.
  const Configuration paper({}, {{"case", {"guv-3to1", "--case"}}});
  EXPECT_EQ(usual_most_cells(paper), 212);
  EXPECT_EQ(configuration_at(paper, {"epsilon"}, {0.03019}, 1).options().cells, 212);
  EXPECT_EQ(configuration_at(paper, {"epsilon"}, {0.03333}, 1).options().cells, 192);
  EXPECT_EQ(there.options().noise_cells, 24);
  EXPECT_NEAR(values_of(there, {"noise-length"})[0], 5 * 10.0 / 3 / 24, 1e-9);
}

TEST_F(CalibrateTest, RefusesWhatItCannotCalibrate) {
  fs::create_directories(folder.path / "one");
  fs::copy_file(folder.path / "data/dataset.toml", folder.path / "one/dataset.toml");
  std::ofstream(folder.path / "one/measurements.csv") << "vesicle,time,rafts\na,1,2\n";
  for (const auto& [flags, complaint] :
       {std::pair<std::string, std::string>("", "--data: a folder of measurements is needed"),
        {"--data " + out("nowhere"), "dataset.toml"},
        {"--data " + out("data"), "--case or --model: a model is needed"},
        {"--data " TRACERAFT_ROOT "/verification/data/synthetic/guv-3to1", "is --case guv-3to1"},
        {"--data " + out("data") + " --parameters D",
         "unknown name in --parameters 'D'; valid: mobility"},
        {"--data " + out("data") + " --parameters epsilon", "mobility must be one of them"},
        {"--data " + out("data") + " --parameters mobility,epsilom", "did you mean 'epsilon'"},
        {"--data " + out("data") + " --parameters mobility,epsilon,epsilon", "given twice"},
        {"--data " + out("data") + " --case guv-2to1 --effect exchange:rate=1",
         "its own unit of time"},
        {"--data " + out("data") + " --case two-rafts", "it must be noise"},
        {"--data " + out("data") + " --model " + out("no.toml"), "--model: "},
        {"--data " + out("data") + " --case guv-2to1 --most-cells 64", "the model's own 128"},
        {"--data " + out("one"), "at least three vesicles"},
        {"--data " + out("data") + " --case guv-2to1 --scaled", "measurements are in seconds"}}) {
    const ProgramEnd refused = traceraft("calibrate " + flags + " --out " + out("c"));
    EXPECT_EQ(refused.code, 2) << flags;
    EXPECT_NE(refused.output.find(complaint), std::string::npos) << refused.output;
    EXPECT_FALSE(fs::exists(folder.path / "c"));
  }
}

}  // namespace
}  // namespace traceraft
