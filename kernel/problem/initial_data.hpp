// Initial concentrations. All are projected, M̃ c₀ = (∫ c φ_i), because nodal values away from Γ_h
// would otherwise act as extra data; the projection keeps ∫c exactly.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/discs/random_discs.hpp"
#include "kernel/fem/surface_space.hpp"
#include "kernel/physics/double_well.hpp"

namespace traceraft::problem {

struct CapRaft {
  Point direction;  // of the centre, seen from the origin
  double angle;     // half opening angle in radians
};

// The request of an initial state; each kind uses its part.
struct InitialRequest {
  double raft_fraction = 0.5;    // mean of (c − a)/(b − a)
  std::int64_t noise_cells = 0;  // cells per edge of the mesh on which noise is drawn; 0: the mesh
  std::uint64_t seed = 1;
  std::vector<CapRaft> caps;
  std::function<double(const Point&)> formula;  // thread-safe
  geometry::LevelSetPtr
      surface;  // where formulas are evaluated; without it, on the triangles of Γ_h
  double epsilon = 0.05;
  physics::DoubleWell well;
};

struct InitialEntry {
  std::string name;
  std::string summary;
  std::vector<ParameterSpec> parameters;
  // One of both: values at the nodes, or at any point of the surface.
  std::function<Vec(const fem::SurfaceSpace&, const InitialRequest&, const Parameters&)> nodal;
  std::function<std::function<double(const Point&)>(const InitialRequest&, const Parameters&)>
      concentration;
};

InitialEntry bernoulli_noise();
InitialEntry band_limited_noise();
InitialEntry cap_rafts();
InitialEntry disc_rafts();
InitialEntry formula_field();

const NamedList<InitialEntry>& initial_fields();

// "band-limited:wavelength=0.3" -> projected nodal concentrations. Throws InputError.
Vec make_initial_field(const std::string& specification, const fem::SurfaceSpace& space,
                       const InitialRequest& request);

// The discs of the initial state `discs`. Throws InputError.
discs::StartingDiscs random_discs(const InitialRequest& request, const Parameters& parameters);

// Equilibrium profiles around caps; the nearest cap counts.
std::function<double(const Point&)> profile_around(const std::vector<CapRaft>& caps,
                                                   const physics::DoubleWell& well, double epsilon);

// L² projection of nodal values with the stabilised mass matrix: M̃ c = M nodal. Throws InputError
// if the data are not finite.
Vec project(const fem::SurfaceSpace& space, VecView nodal);

}  // namespace traceraft::problem
