// The version is said in CMakeLists.txt; what has to repeat it is held against it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace traceraft {
namespace {

std::vector<std::string> lines_of(const char* file) {
  std::ifstream in(std::filesystem::path(TRACERAFT_ROOT) / file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  EXPECT_FALSE(lines.empty()) << file;
  return lines;
}

// "key: value" of the first level; "" if it is not there.
std::string value_of(const std::vector<std::string>& lines, const std::string& key) {
  for (const std::string& line : lines)
    if (line.compare(0, key.size() + 2, key + ": ") == 0) return line.substr(key.size() + 2);
  return "";
}

TEST(ReleaseFiles, TheChangelogBeginsWithTheVersion) {
  const std::regex heading("## (\\d+\\.\\d+\\.\\d+) - (\\d{4}-\\d{2}-\\d{2})");
  std::vector<std::pair<std::string, std::string>> versions;
  for (const std::string& line : lines_of("CHANGELOG.md")) {
    std::smatch found;
    if (std::regex_match(line, found, heading)) versions.emplace_back(found[1], found[2]);
    EXPECT_EQ(line.compare(0, 3, "## ") == 0, !found.empty()) << line;
  }
  ASSERT_FALSE(versions.empty());
  EXPECT_EQ(versions.front().first, TRACERAFT_VERSION);
  EXPECT_EQ(versions.front().second, TRACERAFT_RELEASE_DATE);
}

TEST(ReleaseFiles, TheCitationSaysTheVersion) {
  const std::vector<std::string> citation = lines_of("CITATION.cff");
  EXPECT_EQ(value_of(citation, "version"), TRACERAFT_VERSION);
  EXPECT_EQ(value_of(citation, "date-released"), TRACERAFT_RELEASE_DATE);
  // Version 1.2.0 of the format requires these.
  EXPECT_EQ(value_of(citation, "cff-version"), "1.2.0");
  for (const char* key : {"message", "title", "type", "license"})
    EXPECT_NE(value_of(citation, key), "") << key;
}

}  // namespace
}  // namespace traceraft
