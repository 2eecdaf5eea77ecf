// Named sets of defaults.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kernel/core/named_list.hpp"

namespace traceraft {

struct CaseEntry {
  std::string name;
  std::string summary;
  std::vector<std::pair<std::string, std::string>> values;  // option, text in µm and s
};

const NamedList<CaseEntry>& cases();

}  // namespace traceraft
