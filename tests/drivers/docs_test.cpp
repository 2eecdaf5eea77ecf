// The documents have short sentences, and their links lead somewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace traceraft {
namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

constexpr int kLongestSentence = 40, kLongestDecision = 1000;
constexpr double kMean = 18, kMeanOfDecisions = 20;

struct MarkdownPage {
  fs::path path;
  Lines lines;

  bool is_decision() const { return path.parent_path().filename() == "decisions"; }
};

// Without blocks of code.
MarkdownPage read_page(const fs::path& path) {
  MarkdownPage page{path, {}};
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);)
    page.lines.push_back(line.rfind("    ", 0) == 0 ? "" : line);
  return page;
}

std::vector<MarkdownPage> documents() {
  const fs::path root = TRACERAFT_ROOT;
  std::vector<MarkdownPage> pages{read_page(root / "README.md")};
  for (const fs::path& folder : {root / "docs", root / "docs/decisions"})
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".md") pages.push_back(read_page(entry.path()));
  return pages;
}

// Headings, tables, remarks and pictures are no sentences.
bool is_prose(const std::string& line) {
  return !std::regex_search(line, std::regex("^ *([#|]|<!--|!\\[|$)"));
}

// Without markup. A piece of code is one word.
std::string without_markup(std::string text) {
  text = std::regex_replace(text, std::regex("`[^`]*`"), "code");
  text = std::regex_replace(text, std::regex("\\[([^\\]]*)\\]\\([^)]*\\)"), "$1");
  return std::regex_replace(text, std::regex("\\*\\*"), "");
}

// Lines that belong together. An item of a list stands alone.
Lines paragraphs(const MarkdownPage& page) {
  Lines found{""};
  for (const std::string& line : page.lines) {
    if (!is_prose(line) || line.rfind("- ", 0) == 0) found.emplace_back();
    if (is_prose(line)) found.back() += line + " ";
  }
  return found;
}

Lines sentences(const std::string& paragraph) {
  static const std::regex end(".*[.!?][)\"]*");
  Lines found{""};
  std::istringstream words(without_markup(paragraph));
  for (std::string word; words >> word;) {
    found.back() += word + " ";
    if (std::regex_match(word, end)) found.emplace_back();
  }
  return found;
}

// Words have a letter, a Greek one perhaps (in UTF-8), or a digit.
int count_words(const std::string& text) {
  const auto is_letter = [](unsigned char c) { return std::isalnum(c) || c == 0xCE || c == 0xCF; };
  std::istringstream words(text);
  int count = 0;
  for (std::string word; words >> word;) count += std::any_of(word.begin(), word.end(), is_letter);
  return count;
}

// The anchors of headings, as viewers of Markdown make them.
std::set<std::string> anchors(const MarkdownPage& page) {
  std::set<std::string> found;
  for (const std::string& line : page.lines) {
    if (line.rfind("#", 0) != 0) continue;
    std::string anchor;
    for (const unsigned char c : line.substr(line.find(' ') + 1))
      if (std::isalnum(c) || c == '-' || c == '_' || c == ' ' || c >= 0x80)
        anchor += c == ' ' ? '-' : static_cast<char>(std::tolower(c));
    found.insert(anchor);
  }
  return found;
}

// Links to files of the repository.
Lines relative_links(const MarkdownPage& page) {
  static const std::regex link("\\]\\((?![a-z]+:)([^)\\s]+)\\)");
  Lines found;
  for (const std::string& line : page.lines)
    for (std::sregex_iterator at(line.begin(), line.end(), link), end; at != end; ++at)
      found.push_back((*at)[1]);
  return found;
}

TEST(DocsTest, SentencesAreShort) {
  for (const MarkdownPage& page : documents()) {
    int total = 0, number = 0;
    for (const std::string& paragraph : paragraphs(page))
      for (const std::string& sentence : sentences(paragraph)) {
        const int count = count_words(sentence);
        EXPECT_LE(count, kLongestSentence) << page.path << ": " << sentence;
        total += count;
        number += count > 0;
      }
    EXPECT_LE(total, number * (page.is_decision() ? kMeanOfDecisions : kMean))
        << page.path << ": " << total << " words in " << number << " sentences";
  }
}

TEST(DocsTest, DecisionsTakeTwoPages) {
  for (const MarkdownPage& page : documents()) {
    int count = 0;
    for (const std::string& line : page.lines) count += count_words(line);
    EXPECT_TRUE(!page.is_decision() || count <= kLongestDecision) << page.path << ": " << count;
  }
}

TEST(DocsTest, LinksLeadToFilesAndHeadings) {
  for (const MarkdownPage& page : documents())
    for (const std::string& link : relative_links(page)) {
      const std::string file = link.substr(0, link.find('#')), at = link.substr(file.size());
      const fs::path target = file.empty() ? page.path : page.path.parent_path() / file;
      EXPECT_TRUE(fs::exists(target)) << page.path << ": " << link;
      EXPECT_TRUE(at.empty() || anchors(read_page(target)).count(at.substr(1)))
          << page.path << ": " << link;
    }
}

}  // namespace
}  // namespace traceraft
