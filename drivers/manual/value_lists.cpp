#include "drivers/manual/value_lists.hpp"

#include <sstream>

#include "backends/list.hpp"
#include "drivers/campaign/campaign_groups.hpp"
#include "drivers/config/cases.hpp"
#include "kernel/effects/effects.hpp"
#include "kernel/physics/mobility.hpp"
#include "kernel/problem/initial_data.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::manual {
namespace {

template <class Entry>
ValueList value_list(const char* name, const char* title, const NamedList<Entry>& entries) {
  ValueList list{name, title, {}};
  for (const Entry& entry : entries) list.values.emplace_back(entry.name, entry.summary);
  return list;
}

template <class Entry>
ValueList value_list(const char* name, const char* title, const NamedList<Entry>& entries,
                     const std::pair<std::string, std::string>& beside) {
  ValueList list = value_list(name, title, entries);
  list.values.push_back(beside);
  return list;
}

}  // namespace

const NamedList<ValueList>& value_lists() {
  static const NamedList<ValueList> lists(
      "list of values",
      {value_list("CASE", "Cases", config::cases()),
       value_list("SURFACE", "Surfaces", geometry::surfaces(),
                  {"formula", "any level set, from --surface-formula"}),
       value_list("MOBILITY", "Mobility laws", physics::mobilities()),
       value_list("EFFECT", "Effects", effects::effects()),
       value_list("INITIAL", "Initial states", problem::initial_fields()),
       value_list("INTEGRATOR", "Integrators", backends::integrators()),
       value_list("SOLVER", "Linear solvers", backends::linear_solvers()),
       value_list("STUDY", "Studies", studies::studies(), {"all", "all that are not by name only"}),
       value_list("GROUP", "Groups of a campaign", campaign::campaign_groups())});
  return lists;
}

OfferedValues offered_values(const std::string& placeholder) {
  const std::string more = ",...";
  std::string one = placeholder;
  OfferedValues offered;
  if (one.size() > more.size() && one.compare(one.size() - more.size(), more.size(), more) == 0) {
    one.resize(one.size() - more.size());
    offered.several = true;
  }
  if (one == "FILE" || one == "DIR") {
    offered.kind = one == "FILE" ? OfferedValues::Kind::files : OfferedValues::Kind::folders;
  } else if (one.find('|') != std::string::npos) {
    offered.kind = OfferedValues::Kind::names;
    std::istringstream words(one);
    for (std::string word; std::getline(words, word, '|');) offered.values.emplace_back(word, "");
  } else {
    for (const ValueList& list : value_lists())
      if (list.name == one) {
        offered.kind = OfferedValues::Kind::names;
        offered.values = list.values;
      }
  }
  return offered;
}

}  // namespace traceraft::manual
