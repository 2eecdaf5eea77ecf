// The one list of verification studies. Adding one is one file and one line in studies.cpp.
#pragma once

#include "kernel/core/named_list.hpp"
#include "verification/studies/study.hpp"

namespace traceraft::studies {

StudyEntry mass_balance_study();
StudyEntry energy_decay_study();
StudyEntry mesh_convergence_study();
StudyEntry surface_geometry_study();
StudyEntry time_order_study();
StudyEntry linear_theory_study();
StudyEntry equilibria_study();
StudyEntry integrator_agreement_study();
StudyEntry coarsening_study();
StudyEntry raft_coarsening_study();
StudyEntry membrane_flow_study();
StudyEntry flow_coarsening_study();
StudyEntry rafts_as_discs_study();
StudyEntry published_vesicles_study();
StudyEntry pfhub_study();
StudyEntry solver_iterations_study();
StudyEntry large_solver_iterations_study();
StudyEntry teko_iterations_study();
StudyEntry large_teko_iterations_study();
StudyEntry operation_cost_study();
StudyEntry step_cost_study();
StudyEntry adaptive_mesh_study();
StudyEntry boundary_width_study();

const NamedList<StudyEntry>& studies();

}  // namespace traceraft::studies
