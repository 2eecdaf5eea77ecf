// traceraft compare as a user meets it.
#include <gtest/gtest.h>

#include <csignal>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::content;
using testing::lines_of;
using testing::Outcome;
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
};

TEST_F(CompareTest, MeasuresRecommendsAndIsExtendedWithoutRepeatingItself) {
  const Outcome first = traceraft("compare " + out() + references() + runs +
                                  "--integrators euler,ida --tolerances 1e-2,1e-3 --repeat 2");
  ASSERT_EQ(first.code, 0) << first.output;
  EXPECT_NE(first.output.find("For an error of"), std::string::npos) << first.output;
  ASSERT_EQ(csv().size(), 5u);
  for (std::size_t row = 1; row < 5; ++row)
    EXPECT_NE(csv()[row].find(row < 3 ? "euler,block," : "ida,block,"), std::string::npos);
  const std::string page = content(folder.path / "c/compare.html");
  EXPECT_NE(page.find("For an error of"), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos) << "is gnuplot installed?";

  const fs::path done = folder.path / "c/runs/ida-block-0.001-1/summary.json";
  const fs::path reference = fs::directory_iterator(folder.path / "references")->path();
  const auto run_time = fs::last_write_time(done);
  const auto reference_time = fs::last_write_time(reference / "summary.json");
  const std::string ida = csv()[4];
  const Outcome second =
      traceraft("compare " + out() + references() + "--integrators euler,ida,rosenbrock");
  ASSERT_EQ(second.code, 0) << second.output;
  EXPECT_EQ(csv().size(), 7u);
  EXPECT_EQ(csv()[4], ida);
  EXPECT_EQ(fs::last_write_time(done), run_time);
  EXPECT_EQ(fs::last_write_time(reference / "summary.json"), reference_time);
}

TEST_F(CompareTest, AFailingCombinationIsARowWithItsReason) {
  // 22,000 unknowns at most for klu: refused; the block solver goes on.
  const Outcome outcome = traceraft(
      "compare " + out() + references() +
      "--case two-rafts --cells 72 --epsilon 0.3 --t-end 1e-4 --integrators ida "
      "--linear-solvers block,klu --tolerances 1e-2 --reference-tolerance 1e-3 --repeat 2");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  ASSERT_EQ(csv().size(), 3u);
  EXPECT_NE(csv()[2].find("klu is for small systems"), std::string::npos) << csv()[2];
  EXPECT_NE(outcome.output.find("not reached by ida with klu"), std::string::npos);
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
  EXPECT_FALSE(fs::exists(folder.path / "c/runs/euler-block-0.0001-1.json"));
  const Outcome resumed = traceraft("compare " + out() + references());
  ASSERT_EQ(resumed.code, 0) << resumed.output;
  EXPECT_EQ(csv().size(), 7u);
}

TEST_F(CompareTest, RefusesWhatDoesNotFit) {
  const auto complaint = [&](const std::string& arguments) {
    const Outcome outcome = traceraft("compare " + references() + arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1);
    return outcome.output;
  };
  EXPECT_NE(complaint(out() + runs + "--integrators eular").find("did you mean 'euler'"),
            std::string::npos);
  EXPECT_NE(complaint(out() + runs + "--tolerance 1e-3").find("--tolerances"), std::string::npos);
  EXPECT_NE(complaint(out() + runs + "--tolerances 7").find("out of range"), std::string::npos);
  EXPECT_NE(complaint(out() + runs + "--cels 7").find("did you mean '--cells'"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder.path / "c"));
  ASSERT_EQ(traceraft("compare --quiet " + out() + references() + runs +
                      "--integrators ida --tolerances 1e-2 --repeat 1")
                .code,
            0);
  EXPECT_NE(complaint(out() + "--case two-rafts --cells 14").find("other runs"), std::string::npos);
}

}  // namespace
}  // namespace traceraft
