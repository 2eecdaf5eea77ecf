// One registration list per kind: entries in a fixed order, found by name, and an unknown name is
// answered with the nearest valid one.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kernel/core/error.hpp"

namespace traceraft {

// The candidate with the smallest edit distance to `name`; empty if there are none.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

// "unknown <kind> 'name'; did you mean 'x'? Valid: a, b, c", without the question where no name is
// near, and without the list where it is long and one is.
std::string unknown_name_message(std::string_view kind, std::string_view name,
                                 const std::vector<std::string>& valid);

// Entry needs a member `name` convertible to std::string.
template <class Entry>
class NamedList {
 public:
  NamedList(std::string kind, std::vector<Entry> entries)
      : kind_(std::move(kind)), entries_(std::move(entries)) {}

  // Throws InputError when no entry has that name; `elsewhere` are names valid beside the list's.
  const Entry& find(std::string_view name, const std::vector<std::string>& elsewhere = {}) const {
    for (const Entry& entry : entries_)
      if (entry.name == name) return entry;
    std::vector<std::string> valid = names();
    valid.insert(valid.end(), elsewhere.begin(), elsewhere.end());
    throw InputError(unknown_name_message(kind_, name, valid));
  }

  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const Entry& entry : entries_) result.emplace_back(entry.name);
    return result;
  }

  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }

 private:
  std::string kind_;
  std::vector<Entry> entries_;
};

}  // namespace traceraft
