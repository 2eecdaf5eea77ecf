// The mesh that a field needs: how coarse it may be, and fine along the boundaries of the phases.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "kernel/fem/refinement_rule.hpp"
#include "kernel/mesh/refinement_forest.hpp"
#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft::simulation {

// The most levels whose largest tetrahedra hold the area of a surface to 1e-5, as remeshes must
// not change it; `cells` per edge of the box are those of the smallest. None if not even two sizes
// do.
std::optional<mesh::RefinementLevels> levels_that_keep_the_area(const geometry::LevelSet& surface,
                                                                std::int64_t cells);

// Fine along the boundaries of this model's phases. The indicator is at most 0.18 in a boundary at
// rest, whatever the well.
fem::RefinementRule boundary_rule(const problem::CahnHilliardModel& model,
                                  const mesh::RefinementLevels& levels,
                                  double threshold = fem::kBoundaryThreshold);

// A field, and a mesh that is as fine as it needs.
struct FieldOnMesh {
  mesh::RefinementForest forest;
  std::shared_ptr<const fem::SurfaceSpace> space;
  Vec field;
};

using MakeSpace = std::function<std::shared_ptr<const fem::SurfaceSpace>(mesh::ActiveMesh mesh)>;

// From a moderate mesh, which is refined and coarsened until it fits the field that make_field
// gives on it.
FieldOnMesh adapted_field(const geometry::LevelSet& surface, const mesh::RefinementLevels& levels,
                          const fem::RefinementRule& rule, const MakeSpace& make_space,
                          const std::function<Vec(const fem::SurfaceSpace&)>& make_field);

}  // namespace traceraft::simulation
