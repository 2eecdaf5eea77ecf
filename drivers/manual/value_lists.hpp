// Values that options take by name. The placeholder of such an option, "INTEGRATOR", is the name of
// the list.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kernel/core/named_list.hpp"

namespace traceraft::manual {

struct ValueList {
  std::string name, title;
  std::vector<std::pair<std::string, std::string>> values;  // and what each is
};

const NamedList<ValueList>& value_lists();

// The values that an option may have.
struct OfferedValues {
  enum class Kind { names, files, folders, anything };
  Kind kind = Kind::anything;
  std::vector<std::pair<std::string, std::string>> values;  // names, and what each is, or ""
  bool several = false;                                     // with commas between them
};

// `placeholder`: the name of a list, words as in "warn|reject|off", "FILE" or "DIR", each perhaps
// with ",..." after it. Others stand for numbers and for free text.
OfferedValues offered_values(const std::string& placeholder);

}  // namespace traceraft::manual
