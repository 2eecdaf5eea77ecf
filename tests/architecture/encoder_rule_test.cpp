// Text reaches another program's language through its encoder only (drivers/text/encoders.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace traceraft {
namespace {

namespace fs = std::filesystem;

// Words that write past the encoders, and the files that may use them since they do encode.
struct Rule {
  std::string words;
  std::vector<std::string> allowed;
};

const std::vector<Rule>& rules() {
  static const std::vector<Rule> list = {
      // Terminals.
      {" printf(", {}},
      {"std::printf(", {}},
      {"fprintf(", {}},
      {"std::cout", {}},
      {"std::cerr", {}},
      {"puts(", {}},
      {"fwrite(", {"drivers/text/say.cpp"}},
      // Files and commands.
      {"ofstream", {}},
      {"fopen(", {}},
      {"popen(", {}},
      {"std::system(", {}},
      {"remove_all(", {}},
      // gnuplot, sh and HTML: who writes them.
      {"set terminal", {"drivers/output/chart.cpp"}},
      {"\"gnuplot\"", {"drivers/output/chart.cpp"}},
      {"#!/bin/sh", {"drivers/ensemble/array_job.cpp"}},
      {"</",
       {"drivers/output/page.cpp", "drivers/output/chart.cpp", "drivers/report/viewer.cpp",
        "backends/zlib/vtu_writer.cpp"}},
      {".raw(", {"drivers/report/viewer.cpp", "drivers/report/report_page.cpp"}},
      // Manual pages and completions of shells.
      {"\\\\fB", {"drivers/manual/manual_page.cpp"}},
      {"\"complete --command", {"drivers/manual/fish_completions.cpp"}},
      {"    case \\\"$1", {"drivers/manual/shell_tables.cpp"}},
      // Markdown: tables and documents.
      {"\"## ", {"drivers/verify/verify_report.cpp"}},
      {"\"![", {"drivers/verify/verify_report.cpp"}},
      {"|---", {}}};
  return list;
}

std::vector<std::string> sources() {
  std::vector<std::string> files;
  for (const char* top : {"drivers", "verification", "backends", "kernel"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(TRACERAFT_ROOT) / top))
      if (const std::string extension = entry.path().extension();
          extension == ".cpp" || extension == ".hpp")
        files.push_back(fs::relative(entry.path(), TRACERAFT_ROOT).string());
  return files;
}

// Without comments, which may name what the code does not use.
std::string code_of(const std::string& file) {
  std::ifstream in(fs::path(TRACERAFT_ROOT) / file);
  std::string code;
  for (std::string line; std::getline(in, line);)
    if (line.find_first_not_of(' ') == std::string::npos ||
        line.compare(line.find_first_not_of(' '), 2, "//") != 0)
      code += line + "\n";
  return code;
}

TEST(EncoderRule, NobodyWritesPastTheEncoders) {
  ASSERT_GT(sources().size(), 300u);
  for (const std::string& file : sources()) {
    const std::string code = code_of(file);
    for (const Rule& rule : rules())
      if (code.find(rule.words) != std::string::npos) {
        EXPECT_TRUE(std::count(rule.allowed.begin(), rule.allowed.end(), file) > 0)
            << file << " writes " << rule.words;
      }
  }
}

// Where they are allowed, the encoders are used.
TEST(EncoderRule, WhoMayWriteUsesThem) {
  const std::vector<std::pair<std::string, std::string>> pairs = {
      {"drivers/output/chart.cpp", "in_gnuplot("},
      {"drivers/ensemble/array_job.cpp", "in_shell("},
      {"drivers/ensemble/array_job.cpp", "in_comment("},
      {"drivers/manual/manual_page.cpp", "in_roff("},
      {"drivers/manual/shell_tables.cpp", "in_shell("},
      {"drivers/manual/bash_completions.cpp", "in_shell("},
      {"drivers/manual/zsh_completions.cpp", "in_shell("},
      {"drivers/manual/fish_completions.cpp", "in_fish("},
      {"drivers/output/page.cpp", "in_html("},
      {"drivers/report/viewer.cpp", "in_html_script("},
      {"drivers/verify/verify_report.cpp", "in_markdown("},
      {"drivers/campaign/campaign_report.cpp", "in_markdown("},
      {"drivers/output/text_table.cpp", "in_markdown("},
      {"drivers/text/say.hpp", "in_terminal("},
      {"drivers/text/say.cpp", "in_one_line("}};
  for (const auto& [file, encoder] : pairs)
    EXPECT_NE(code_of(file).find(encoder), std::string::npos) << file << " without " << encoder;
}

}  // namespace
}  // namespace traceraft
