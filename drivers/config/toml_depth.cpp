#include "drivers/config/toml_depth.hpp"

#include <algorithm>
#include <cstring>

namespace traceraft::config {
namespace {

// The end of what is in quotes from `begin` on. One that is not closed ends with its line, or, if
// it begins with three quotes, with the text.
std::size_t end_of_quoted(const std::string& text, std::size_t begin) {
  const char quote = text[begin];
  const std::string three(3, quote);
  const bool several_lines = text.compare(begin, 3, three) == 0;
  for (std::size_t i = begin + (several_lines ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"')
      ++i;
    else if (several_lines ? text.compare(i, 3, three) == 0 : text[i] == quote)
      return i + (several_lines ? 3 : 1);
    else if (text[i] == '\n' && !several_lines)
      return i;
  }
  return text.size();
}

bool goes_on_with_a_key(char ch) {
  return std::strchr(" \t-_", ch) || (ch >= '0' && ch <= '9') || (ch >= 'A' && ch <= 'Z') ||
         (ch >= 'a' && ch <= 'z');
}

}  // namespace

long line_of_deep_key(const std::string& text) {
  int parts = 1;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '"' || text[i] == '\'') {
      i = end_of_quoted(text, i);
      continue;
    }
    if (text[i] == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (text[i] == '.') {
      if (++parts > kMostKeyParts)
        return 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n');
    } else if (!goes_on_with_a_key(text[i])) {
      parts = 1;
    }
    ++i;
  }
  return 0;
}

}  // namespace traceraft::config
