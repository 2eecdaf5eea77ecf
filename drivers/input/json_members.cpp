#include "drivers/input/json_members.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::input {

void check_value(const std::string& where, double value, const WithinRange& range) {
  if (value >= range.low && value <= range.high) return;
  if (std::isnan(value) && range.may_be_unknown) return;
  if (std::isnan(value)) throw DamagedFile(where + " is damaged: it is no number");
  throw InputError(where + ": " + format_number(value) + " is out of range (allowed: " +
                   format_number(range.low) + " to " + format_number(range.high) + ")");
}

void check_value(const std::string& where, const std::string& name, const OneOf& list) {
  if (std::find(list.names.begin(), list.names.end(), name) == list.names.end())
    throw InputError(where + ": " + unknown_name_message(list.kind, name, list.names));
}

}  // namespace traceraft::input
