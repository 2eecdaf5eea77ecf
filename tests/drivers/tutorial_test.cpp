// The commands of the tutorial are run in an empty folder, and print what it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

struct Step {
  std::string command;
  std::vector<std::string> output;  // lines of it; "..." stands for others
};

// Blocks of code are indented; those that begin with a program's name are commands.
std::vector<Step> steps_of_tutorial() {
  std::ifstream page(std::string(TRACERAFT_ROOT) + "/docs/tutorial.md");
  std::vector<Step> steps;
  const std::string indent(4, ' ');
  for (std::string line; std::getline(page, line);) {
    if (line.rfind(indent, 0) != 0) continue;
    const std::string text = line.substr(indent.size());
    if (text.rfind("traceraft ", 0) == 0 || text.rfind("cat ", 0) == 0)
      steps.push_back({text, {}});
    else
      steps.back().output.push_back(text);
  }
  return steps;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

// Numbers may differ as the libraries of two machines do.
bool alike(const std::string& said, const std::string& printed) {
  constexpr double kTolerance = 0.05;
  if (said == printed) return true;
  char *end = nullptr, *other_end = nullptr;
  const double a = std::strtod(said.c_str(), &end), b = std::strtod(printed.c_str(), &other_end);
  return end != said.c_str() && std::string(end) == other_end &&
         std::fabs(a - b) <= kTolerance * std::fabs(a);
}

bool is_line(const std::string& said, const std::string& printed) {
  const std::vector<std::string> a = words_of(said), b = words_of(printed);
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), alike);
}

bool is_printed(const std::string& said, const std::string& output) {
  if (said == "..." || words_of(said) == std::vector<std::string>{"..."}) return true;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);)
    if (is_line(said, line)) return true;
  return false;
}

TEST(Tutorial, PrintsWhatItSays) {
  const testing::TemporaryFolder folder;
  const std::string program = TRACERAFT_PROGRAM;
  const std::string there = "cd '" + folder.path.string() + "' && PATH='" +
                            program.substr(0, program.rfind('/')) + "':\"$PATH\" && ";
  const std::vector<Step> steps = steps_of_tutorial();
  ASSERT_GE(steps.size(), 7u);
  for (const Step& step : steps) {
    const testing::ProgramEnd end = testing::shell(there + step.command);
    ASSERT_EQ(end.code, 0) << step.command << "\n" << end.output;
    for (const std::string& line : step.output)
      EXPECT_TRUE(is_printed(line, end.output)) << line << "\nnot in\n" << end.output;
  }
  for (const char* file : {"vesicle/view.png", "vesicle/report.html", "found/explain.html"})
    EXPECT_TRUE(std::filesystem::exists(folder.path / file)) << file;
}

}  // namespace
}  // namespace traceraft
