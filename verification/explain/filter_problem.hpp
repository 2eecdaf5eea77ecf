// What a model is held against: a series of measured fields, on the mesh of the model.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "kernel/geometry/level_set.hpp"
#include "kernel/linear/linear_solver.hpp"
#include "verification/bench.hpp"
#include "verification/explain/field_estimate.hpp"
#include "verification/explain/field_series.hpp"
#include "verification/explain/gap_patterns.hpp"

namespace traceraft {

struct FilterSettings {
  int rank = 240;         // directions in which the state is uncertain
  int replicates = 199;   // of the noise, through everything that is linear
  int tangent_steps = 3;  // between two snapshots, for derivatives by parameters
  int error_steps = 2;    // the same for errors of the state
  double gain = 0.1;      // standard deviations of the scale and of the zero of each snapshot's
  double offset = 0.1;    // values, as far as they are unknown
  double turn = 0.05;     // of the angle by which a vesicle may have turned between two snapshots
  int gap_degree = 6;     // of the polynomials that gaps are sought as
};

// Everything about a series that does not depend on parameters: where it was measured, on the mesh
// of the model and on a finer one that shows what the model's own mesh does.
struct FilterProblem {
  std::shared_ptr<const ThreadTeam> team;
  SpacePtr space, fine;                // of one thread
  EigenMatrix mass;                    // stabilised, on `space`
  std::vector<NoisyValues> snapshots;  // on `space`
  std::vector<double> times;           // in units of R²/D of the base model
  std::size_t train = 0;               // snapshots that count
  std::vector<PointTrace> fine_trace;  // where they were measured, on `fine`
  PointTrace to_fine, from_fine;       // nodal values from one mesh to the other
  FieldEstimate first;                 // of the first snapshot
  double noise;                        // of all of them
  std::shared_ptr<const GapPatterns> patterns;
  LinearSolverFactory tangent_solver;
  std::function<IntegratorPtr(const DaeProblem&, const SurfaceSpace&)> make_integrator;
};

// Of one thread, which its matrices and solvers use.
SpacePtr serial_space(const LevelSet& surface, int cells);

// `held_out`: so many snapshots at the end are forecast, but count for nothing.
FilterProblem make_filter_problem(const FieldSeries& series, const LevelSet& surface,
                                  double epsilon, int cells, int fine_cells, int threads,
                                  std::size_t held_out, const FilterSettings& settings);

}  // namespace traceraft
