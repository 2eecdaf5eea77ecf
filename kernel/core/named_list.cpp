#include "kernel/core/named_list.hpp"

#include <algorithm>
#include <numeric>

namespace traceraft {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  const auto closer = [&](const std::string& a, const std::string& b) {
    return edit_distance(name, a) < edit_distance(name, b);
  };
  const auto best = std::min_element(candidates.begin(), candidates.end(), closer);
  return best == candidates.end() ? std::string() : *best;
}

std::string unknown_name_message(std::string_view kind, std::string_view name,
                                 const std::vector<std::string>& valid) {
  // A name can come from a file: keep the message to one readable line.
  std::string shown(name.substr(0, 60));
  for (char& ch : shown)
    if (static_cast<unsigned char>(ch) < 32) ch = '?';
  std::string message = "unknown " + std::string(kind) + " '" + shown + "'";
  // What shares little with a name is no slip of the pen; the dashes of flags are no letters.
  const std::size_t letters = shown.size() - std::min(shown.size(), shown.find_first_not_of('-'));
  const std::string nearest = nearest_name(shown, valid);
  const bool begun = !shown.empty() && nearest.compare(0, shown.size(), shown) == 0;
  const bool near = begun || (!valid.empty() && 2 * edit_distance(shown, nearest) < letters);
  if (near) message += "; did you mean '" + nearest + "'?";
  if (!near || valid.size() <= 12) {
    message += near ? " Valid:" : "; valid:";
    for (std::size_t i = 0; i < valid.size(); ++i) message += (i ? ", " : " ") + valid[i];
  }
  return message;
}

}  // namespace traceraft
