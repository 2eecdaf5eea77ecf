// traceraft compare as a user meets it.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <fstream>

#include "backends/posix/durable_file.hpp"
#include "backends/posix/folder_lock.hpp"
#include "drivers/run/checkpoint_store.hpp"
#include "tests/support/program.hpp"
#include "tests/support/spaces.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::content;
using testing::json_of;
using testing::lines_of;
using testing::names;
using testing::ProgramEnd;
using testing::TemporaryFolder;
using testing::traceraft;
namespace fs = std::filesystem;

class CompareTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  std::string out() const { return "--out " + (folder.path / "c").string() + " "; }
  std::string references() const {
    return "--references " + (folder.path / "references").string() + " ";
  }
  const std::string runs = "--case two-rafts --cells 12 --epsilon 1 --t-end 0.3 ";
  std::vector<std::string> csv() const {
    std::vector<std::string> lines;
    std::istringstream text(content(folder.path / "c/compare.csv"));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }
  // The cells of a row by the names in the heading.
  std::map<std::string, std::string> row(std::size_t number) const {
    const std::vector<std::string> names = cells(csv()[0]), values = cells(csv()[number]);
    EXPECT_EQ(names.size(), values.size()) << csv()[number];
    std::map<std::string, std::string> result;
    for (std::size_t k = 0; k < std::min(names.size(), values.size()); ++k)
      result[names[k]] = values[k];
    return result;
  }
  double number(std::size_t row_number, const char* name) const {
    return std::stod(row(row_number).at(name));
  }
  nlohmann::json summary(const std::string& job) const {
    return testing::json_of(folder.path / "c/runs" / job / "summary.json");
  }
  std::vector<fs::path> all_references() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder.path / "references"))
      found.push_back(entry.path());
    return found;
  }
  static void damage_newest_checkpoint(const fs::path& run) {
    fs::path newest;
    for (const auto& entry : fs::directory_iterator(run / "checkpoints"))
      newest = std::max(newest, entry.path());
    std::fstream file(newest, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(200);
    file.write("####", 4);
  }

 private:
  static std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> result(1);
    bool quoted = false;
    for (const char ch : line) {
      if (ch == '"') quoted = !quoted;
      if (ch == ',' && !quoted)
        result.emplace_back();
      else
        result.back() += ch;
    }
    return result;
  }
};

TEST_F(CompareTest, MeasuresRecommendsAndIsExtendedWithoutRepeatingItself) {
  const ProgramEnd first = traceraft("compare " + out() + references() + runs +
                                     "--integrators euler,ida --keep first --tolerances 1e-2,1e-3 "
                                     "--repeat 2");
  ASSERT_EQ(first.code, 0) << first.output;
  ASSERT_EQ(csv().size(), 5u);
  for (std::size_t row = 1; row < 5; ++row)
    EXPECT_TRUE(names(csv()[row], row < 3 ? "euler,block," : "ida,block,"));
  EXPECT_TRUE(names(content(folder.path / "c/compare.html"), "<svg")) << "is gnuplot installed?";

  const fs::path done = folder.path / "c/runs/ida-block-0.001-1/summary.json";
  const fs::path reference = fs::directory_iterator(folder.path / "references")->path();
  const auto run_time = fs::last_write_time(done);
  const auto reference_time = fs::last_write_time(reference / "summary.json");
  const std::string ida = csv()[4];
  const ProgramEnd second =
      traceraft("compare " + out() + references() + "--integrators euler,ida,rosenbrock");
  ASSERT_EQ(second.code, 0) << second.output;
  ASSERT_EQ(csv().size(), 7u);
  EXPECT_EQ(csv()[4], ida);
  EXPECT_EQ(fs::last_write_time(done), run_time);
  EXPECT_EQ(fs::last_write_time(reference / "summary.json"), reference_time);
}

TEST_F(CompareTest, ErrorsTimesAndCountsAreThoseOfTheRuns) {
  const ProgramEnd outcome = traceraft("compare " + out() + references() + runs +
                                       "--integrators ida,rosenbrock --tolerances 1e-2,1e-4 "
                                       "--repeat 2 --target-error 3e-3");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_TRUE(names(outcome.output, "3.0e-03"));
  // No method reaches what is asked for: that is an answer. So is that nothing is asked for again.
  const ProgramEnd none = traceraft("compare " + out() + references() + "--target-error 1e-15");
  EXPECT_EQ(none.code, 0);
  EXPECT_TRUE(names(none.output, "1.0e-15"));
  ASSERT_EQ(traceraft("compare " + out() + references() + "--target-error 0").code, 0);
  const auto space = testing::make_space(12);
  const auto concentration = [&](const fs::path& run) {
    return run::concentration_of(run::CheckpointStore(run / "checkpoints").newest(), run,
                                 space->nodes());
  };
  const Vec reference = concentration(all_references().at(0));
  const std::vector<std::string> jobs = {"ida-block-0.01", "ida-block-1e-04",
                                         "rosenbrock-block-0.01", "rosenbrock-block-1e-04"};
  ASSERT_EQ(csv().size(), jobs.size() + 1);
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    const Vec difference = concentration(folder.path / "c/runs" / (jobs[k] + "-1")) - reference;
    const double error =
        std::sqrt(space->inner(difference, difference) / space->inner(reference, reference));
    EXPECT_NEAR(number(k + 1, "error") / error, 1, 1e-6) << jobs[k];
    const nlohmann::json first = summary(jobs[k] + "-1"), second = summary(jobs[k] + "-2");
    for (const char* count : {"steps", "residuals", "linear_iterations", "threads"})
      EXPECT_EQ(number(k + 1, count), first.at(count).get<double>()) << count;
    for (const std::string clock : {"cpu_s", "wall_s"}) {
      const double a = first.at(clock), b = second.at(clock);
      EXPECT_NEAR(number(k + 1, clock.c_str()), 0.5 * (a + b), 1e-9) << clock;
      EXPECT_NEAR(number(k + 1, (clock + "_low").c_str()), std::min(a, b), 1e-9);
      EXPECT_NEAR(number(k + 1, (clock + "_high").c_str()), std::max(a, b), 1e-9);
    }
    EXPECT_EQ(number(k + 1, "repetitions"), 2);
  }
  EXPECT_GT(number(1, "error"), 3 * number(2, "error")) << "the tolerance does not reach the runs";
  EXPECT_GT(number(3, "error"), 3 * number(4, "error"));
}

TEST_F(CompareTest, ATighterToleranceBringsATighterReference) {
  ASSERT_EQ(traceraft("compare --quiet " + out() + references() + runs +
                      "--integrators ida --tolerances 1e-2 --repeat 1")
                .code,
            0);
  const double alone = number(1, "error");
  ASSERT_EQ(traceraft("compare --quiet " + out() + references() + "--tolerances 1e-4,0.01").code,
            0);
  ASSERT_EQ(csv().size(), 3u);
  EXPECT_EQ(all_references().size(), 2u);
  EXPECT_NEAR(number(1, "error") / alone, 1, 0.1);
  EXPECT_LT(number(2, "error"), 0.1 * alone);
  EXPECT_TRUE(names(content(folder.path / "c/compare.html"), "1e-06"));
}

TEST_F(CompareTest, RunsThatTakeTooLongAreRowsUntilTheyMayTakeLonger) {
  const ProgramEnd impatient =
      traceraft("compare " + out() + references() +
                "--case spinodal --cells 16 --integrators euler --tolerances 1e-4 --repeat 2 "
                "--reference-tolerance 1e-5 --time-limit 0.1");
  EXPECT_EQ(impatient.code, 3) << impatient.output;
  EXPECT_TRUE(names(row(1).at("failure"), " 0.1 s"));
  EXPECT_FALSE(fs::exists(folder.path / "c/runs/euler-block-1e-04-2"));
  const ProgramEnd patient = traceraft("compare " + out() + references() + "--time-limit 60");
  EXPECT_EQ(patient.code, 0) << patient.output;
  EXPECT_EQ(row(1).at("failure"), "");
  EXPECT_EQ(number(1, "repetitions"), 2);
}

TEST_F(CompareTest, BelievesNoDamagedResult) {
  ASSERT_EQ(traceraft("compare --quiet " + out() + references() + runs +
                      "--integrators ida --tolerances 1e-2 --repeat 1")
                .code,
            0);
  const fs::path run = folder.path / "c/runs/ida-block-0.01-1";
  for (const fs::path& broken : {run, all_references().at(0)}) {
    const fs::path kept = folder.path / "kept";
    fs::remove_all(kept);
    fs::copy(broken, kept, fs::copy_options::recursive);
    damage_newest_checkpoint(broken);
    const ProgramEnd outcome = traceraft("compare --quiet " + out() + references());
    EXPECT_EQ(outcome.code, 4) << outcome.output;
    EXPECT_TRUE(names(outcome.output, broken.filename().string()));
    fs::remove_all(broken);
    fs::copy(kept, broken, fs::copy_options::recursive);
  }
  for (const char* nonsense : {"[1]", "{\"failure\": null}", "{"}) {
    std::ofstream(folder.path / "c/runs/ida-block-0.01-1.json") << nonsense;
    const ProgramEnd outcome = traceraft("compare --quiet " + out() + references());
    EXPECT_EQ(outcome.code, 4) << outcome.output;
    EXPECT_TRUE(names(outcome.output, "ida-block-0.01-1.json"));
  }
}

// A comparison that is killed takes its run with it, so that nothing works on its folder later.
TEST_F(CompareTest, LeavesNoRunBehindWhenItIsKilled) {
  const pid_t child = testing::start_traceraft(
      "compare --quiet " + out() + references() +
      "--case spinodal --cells 40 --integrators euler --tolerances 1e-4 --repeat 1 "
      "--reference-tolerance 1e-5");
  fs::path reference;
  for (int i = 0; i < 3000 && reference.empty(); ++i, usleep(10000))
    if (fs::exists(folder.path / "references") && !fs::is_empty(folder.path / "references"))
      reference = all_references().at(0);
  for (int i = 0; i < 3000 && testing::lines_of(reference / "series.csv") < 3; ++i) usleep(10000);
  EXPECT_THROW(posix::FolderLock{reference}, posix::LockedError);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  bool free = false;
  for (int i = 0; i < 1000 && !free; ++i, usleep(10000)) try {
      const posix::FolderLock lock(reference);
      free = true;
    } catch (const posix::LockedError&) {
    }
  EXPECT_TRUE(free);
  EXPECT_EQ(nlohmann::json::parse(content(reference / "summary.json")).at("end"), "stopped");
}

TEST_F(CompareTest, OneAtATimeWorksOnAFolder) {
  ASSERT_EQ(traceraft("compare --quiet " + out() + references() + runs +
                      "--integrators ida --tolerances 1e-2 --repeat 1")
                .code,
            0);
  const posix::FolderLock lock(folder.path / "c");
  EXPECT_EQ(traceraft("compare --quiet " + out() + references()).code, 6);
}

TEST_F(CompareTest, DoesNotMixBuildsOfTheProgram) {
  const auto compare = [&](const std::string& arguments) {
    return traceraft("compare --quiet " + out() + references() + arguments);
  };
  ASSERT_EQ(compare(runs + "--integrators ida --tolerances 1e-2 --repeat 1").code, 0);
  ASSERT_EQ(compare("").code, 0);
  const fs::path file = folder.path / "c/plan.json";
  nlohmann::json plan = json_of(file);
  plan["program"] = "00000000";
  posix::write_durably(file, plan.dump());
  EXPECT_TRUE(testing::refuses(compare("--repeat 2"), "build"));
  EXPECT_EQ(content(file), plan.dump());
}

TEST_F(CompareTest, NoticesThatTheInitialStateHasChanged) {
  const std::string source = (folder.path / "source").string();
  const auto make_source = [&](const char* angle) {
    fs::remove_all(source);
    ASSERT_EQ(traceraft("run --quiet --no-fields --case two-rafts --cells 12 --epsilon 1 "
                        "--t-end 0.01 --initial-caps \"0 0 1 " +
                        std::string(angle) + "\" --out " + source)
                  .code,
              0);
  };
  make_source("60");
  const ProgramEnd first =
      traceraft("compare " + out() + references() +
                "--case spinodal --cells 12 --t-end 0.1 --initial restart:" + source +
                " --integrators ida --tolerances 1e-2 --repeat 1");
  ASSERT_EQ(first.code, 0) << first.output;
  make_source("80");
  const ProgramEnd outcome = traceraft("compare " + out() + references());
  EXPECT_TRUE(testing::refuses(outcome, "initial state"));
}

TEST_F(CompareTest, AFailingCombinationIsARowWithItsReason) {
  // 22,000 unknowns at most for klu: refused; the block solver goes on.
  const ProgramEnd outcome = traceraft(
      "compare " + out() + references() +
      "--case two-rafts --cells 72 --epsilon 0.3 --t-end 1e-4 --integrators ida "
      "--linear-solvers block,klu --tolerances 1e-2 --reference-tolerance 1e-3 --repeat 2");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  ASSERT_EQ(csv().size(), 3u);
  for (const char* fact : {"klu", "25000"}) EXPECT_TRUE(names(row(2).at("failure"), fact));
  EXPECT_EQ(row(2).at("error"), "");
}

TEST_F(CompareTest, GoesOnAfterAnInterruption) {
  const std::string arguments = "compare " + out() + references() + runs +
                                "--integrators ida,euler --tolerances 1e-2,1e-3,1e-4 --repeat 1";
  const pid_t child = testing::start_traceraft(arguments + " --quiet");
  const fs::path first = folder.path / "c/runs/ida-block-0.01-1.json";
  for (int i = 0; i < 6000 && !fs::exists(first); ++i) usleep(10000);
  ASSERT_TRUE(fs::exists(first));
  kill(child, SIGTERM);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_EQ(WEXITSTATUS(status), 5);
  EXPECT_FALSE(fs::exists(folder.path / "c/runs/euler-block-1e-04-1.json"));
  const ProgramEnd resumed = traceraft("compare " + out() + references());
  ASSERT_EQ(resumed.code, 0) << resumed.output;
  ASSERT_EQ(csv().size(), 7u);
  for (std::size_t k = 1; k < 7; ++k) EXPECT_EQ(row(k).at("failure"), "") << k;
}

TEST_F(CompareTest, RefusesWhatDoesNotFit) {
  const auto complaint = [&](const std::string& arguments) {
    const ProgramEnd outcome = traceraft("compare " + references() + arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1);
    return outcome.output;
  };
  for (const auto& [arguments, fact] :
       {std::pair(out() + runs + "--integrators eular", "'euler'"),
        {out() + runs + "--tolerance 1e-3", "--tolerances"},
        {out() + runs + "--tolerances 7", "--tolerances"},
        {out() + runs + "--cels 7", "'--cells'"},
        {out() + runs + "--ida-rtol 1e-3", "--tolerances"},
        {out() + runs + "--integrators ida --keep first", "--keep"},
        {out() + runs + "--target-error nan", "'nan'"},
        {out() + runs + "--tolerances 1e-3 --reference-tolerance 1e-3", "1e-04"},
        {out(), "--out"},
        {"", "--case"}})
    EXPECT_TRUE(names(complaint(arguments), fact));
  EXPECT_FALSE(fs::exists(folder.path / "c"));
  std::ofstream(folder.path / "file") << "text";
  const std::string file = (folder.path / "file").string();
  EXPECT_TRUE(names(complaint("--out " + file + " " + runs), file));
  const std::string run = (folder.path / "run").string();
  ASSERT_EQ(traceraft("run --quiet --no-fields --out " + run + " " + runs).code, 0);
  const std::string config = content(run + "/config.toml");
  EXPECT_TRUE(names(complaint("--out " + run + " --case spinodal --cells 12"), run));
  EXPECT_EQ(content(run + "/config.toml"), config);
  ASSERT_EQ(traceraft("compare --quiet " + out() + references() + runs +
                      "--integrators ida --tolerances 1e-2 --repeat 1")
                .code,
            0);
  EXPECT_TRUE(names(complaint(out() + "--case two-rafts --cells 14"), "--out"));
  EXPECT_TRUE(names(complaint(out() + "--threads 7"), "--threads"));
}

}  // namespace
}  // namespace traceraft
