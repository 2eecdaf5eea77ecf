#include "kernel/physics/mobility.hpp"

namespace traceraft::physics {

const NamedList<MobilityEntry>& mobilities() {
  static const std::vector<MobilityEntry> entries = {
      degenerate_mobility(),
      constant_mobility(),
  };
  static const NamedList<MobilityEntry> list("mobility", entries);
  return list;
}

MobilityPtr make_mobility(const std::string& specification) {
  const NamedArguments request = split_named_arguments(specification);
  const MobilityEntry& entry = mobilities().find(request.name);
  return entry.make(
      parse_parameters("mobility '" + entry.name + "'", request.arguments, entry.parameters));
}

}  // namespace traceraft::physics
