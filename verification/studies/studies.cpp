#include "verification/studies/studies.hpp"

namespace traceraft::studies {

const NamedList<StudyEntry>& studies() {
  static const std::vector<StudyEntry> entries = {
      mass_balance_study(),
      energy_decay_study(),
      mesh_convergence_study(),
      surface_geometry_study(),
      time_order_study(),
      linear_theory_study(),
      equilibria_study(),
      coarsening_study(),
      raft_coarsening_study(),
      membrane_flow_study(),
      flow_coarsening_study(),
      rafts_as_discs_study(),
      published_vesicles_study(),
      pfhub_study(),
      integrator_agreement_study(),
      solver_iterations_study(),
      teko_iterations_study(),
      large_solver_iterations_study(),
      large_teko_iterations_study(),
      operation_cost_study(),
      step_cost_study(),
      adaptive_mesh_study(),
      boundary_width_study(),
  };
  static const NamedList<StudyEntry> list("study", entries);
  return list;
}

}  // namespace traceraft::studies
