// Forecasts free of the error of the model's mesh, as far as two finer meshes can tell.
#pragma once

#include <array>
#include <functional>

#include "kernel/geometry/level_set.hpp"
#include "verification/assimilation/fields/field_estimate.hpp"
#include "verification/assimilation/fields/field_series.hpp"
#include "verification/assimilation/fields/mesh_transfer.hpp"

namespace traceraft::assimilation {

// The integrator of all forecasts.
using MakeForecaster =
    std::function<time::IntegratorPtr(const problem::DaeProblem&, const fem::SurfaceSpace&)>;

// A space of one thread, which its matrices and solvers use.
bench::SpacePtr serial_space(const geometry::LevelSetPtr& surface, int cells,
                             double mass_stabilisation = fem::kMassStabilisation);

// The two finer meshes. They do not depend on the model.
struct FinerMeshes {
  std::array<bench::SpacePtr, 2> spaces;  // the finest last
  MeshTransfer to_finest,                 // from the model's mesh to the finest
      from_finest;                        // from the finest to the model's mesh
  MeshTransfer up,                        // from the first of the two to the finest
      down;                               // from the finest to the first of the two
};
FinerMeshes finer_meshes(const geometry::LevelSetPtr& surface, const bench::SpacePtr& own,
                         int cells);

// The traces on each of the two meshes, one per snapshot: where it was measured.
using FinerTraces = std::array<std::vector<PointTrace>, 2>;
FinerTraces finer_traces(const FinerMeshes& meshes, const FieldSeries& series);

// A state on the finest mesh. On the mesh of a model phase boundaries may be as wide as a cell:
// what it lacks of their shape then acts on the flow like a line tension.
class ResolvedForecast {
 public:
  ResolvedForecast(const FinerMeshes& meshes, const FinerTraces& traces,
                   const problem::CahnHilliardModel& model, Vec c,
                   const MakeForecaster& make_integrator);

  // The forecast at its end. Errors of order h² are extrapolated (Richardson).
  struct End {
    Vec field,         // c at the nodes of the model's mesh
        doubt;         // by how much it was extrapolated
    Vec values,        // c where snapshot k was measured
        values_doubt;  // by how much it was extrapolated
  };
  // `turn`: by which the vesicle turns at the end, on the finest mesh; may be null. Throws
  // std::runtime_error if the flow cannot be advanced.
  End advance(std::size_t k, double begin, double end, const MeshTransfer* turn = nullptr);
  void correct(VecView increment) { c_ += meshes_.to_finest(increment); }  // of the model's mesh

 private:
  const FinerMeshes& meshes_;
  const FinerTraces& traces_;
  std::array<problem::CahnHilliard, 2> problems_;
  MakeForecaster make_integrator_;
  Vec c_;
};

}  // namespace traceraft::assimilation
