#include "kernel/geometry/surface_entries.hpp"

namespace traceraft::geometry {

const NamedList<SurfaceEntry>& surfaces() {
  static const std::vector<SurfaceEntry> entries = {
      sphere_surface(), ellipsoid_surface(), torus_surface(), biconcave_surface(), dziuk_surface(),
  };
  static const NamedList<SurfaceEntry> list("surface", entries);
  return list;
}

LevelSetPtr make_surface(const std::string& specification) {
  const NamedArguments request = split_named_arguments(specification);
  const SurfaceEntry& entry = surfaces().find(request.name);
  return entry.make(
      parse_parameters("surface '" + entry.name + "'", request.arguments, entry.parameters));
}

}  // namespace traceraft::geometry
