#include "kernel/core/named_list.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace traceraft {
namespace {

// Letters inserted, left out, replaced, or swapped with their neighbour (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> earlier, before(b.size() + 1), row;
  std::iota(before.begin(), before.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    row = {i + 1};
    for (std::size_t j = 0; j < b.size(); ++j) {
      row.push_back(std::min({before[j] + (a[i] != b[j]), row[j] + 1, before[j + 1] + 1}));
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
        row.back() = std::min(row.back(), earlier[j - 1] + 1);
    }
    earlier = std::exchange(before, row);
  }
  return before.back();
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
  // A name can come from a file: keep the message readable.
  const std::string shown(name.substr(0, 60));
  std::string message = "unknown " + std::string(kind) + " '" + shown + "'";
  // A word unlike every name is no slip of the pen; the dashes of flags are no letters.
  const std::size_t letters = shown.size() - std::min(shown.size(), shown.find_first_not_of('-'));
  const std::string nearest = nearest_name(shown, valid);
  const bool begun = !shown.empty() && nearest.compare(0, shown.size(), shown) == 0;
  const bool near = begun || (!valid.empty() && 2 * edit_distance(shown, nearest) < letters);
  if (near) message += "; did you mean '" + nearest + "'?";
  if (valid.empty()) return message + "; there are none";
  if (!near || valid.size() <= 12) {
    message += near ? " Valid:" : "; valid:";
    for (std::size_t i = 0; i < valid.size(); ++i) message += (i ? ", " : " ") + valid[i];
  }
  return message;
}

}  // namespace traceraft
