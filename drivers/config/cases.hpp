// Named sets of defaults.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kernel/core/named_list.hpp"

namespace traceraft::config {

struct CaseEntry {
  std::string name;
  std::string summary;
  std::vector<std::pair<std::string, std::string>> values;  // option, text in µm and s
  std::string composition = {};  // of the membrane, DOPC : DPPC : mol % of cholesterol
  // Options of its mesh. They count together, unless the user chooses another mesh or other cells.
  std::vector<std::pair<std::string, std::string>> mesh = {};
};

const NamedList<CaseEntry>& cases();

}  // namespace traceraft::config
