// One declaration per built-in surface; each is defined in the file of its name.
#pragma once

#include "kernel/geometry/level_set.hpp"

namespace traceraft::geometry {

SurfaceEntry sphere_surface();
SurfaceEntry ellipsoid_surface();
SurfaceEntry torus_surface();
SurfaceEntry biconcave_surface();
SurfaceEntry dziuk_surface();

}  // namespace traceraft::geometry
