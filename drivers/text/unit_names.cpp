#include "drivers/text/unit_names.hpp"

namespace traceraft::text {

std::string unit_name(Unit unit, bool scaled) {
  switch (unit) {
    case Unit::time:
      return scaled ? "R^2/D" : "s";
    case Unit::length:
      return scaled ? "R" : "um";
    case Unit::area:
      return scaled ? "R^2" : "um^2";
    case Unit::seconds:
      return "s";
    case Unit::megabytes:
      return "MB";
    default:
      return "";
  }
}

std::string with_unit(const std::string& name, Unit unit, bool scaled) {
  const std::string text = unit_name(unit, scaled);
  return text.empty() ? name : name + " (" + text + ")";
}

std::string without_unit(const std::string& heading) {
  for (const Unit unit : {Unit::time, Unit::length, Unit::area})
    for (const bool scaled : {false, true}) {
      const std::string end = with_unit("", unit, scaled);
      if (heading.size() > end.size() &&
          heading.compare(heading.size() - end.size(), end.size(), end) == 0)
        return heading.substr(0, heading.size() - end.size());
    }
  return heading;
}

}  // namespace traceraft::text
