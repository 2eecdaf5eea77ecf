#include "verification/studies.hpp"

namespace traceraft {

const NamedList<StudyEntry>& studies() {
  static const std::vector<StudyEntry> entries = {
      mesh_convergence_study(),  time_order_study(),      integrator_agreement_study(),
      solver_iterations_study(), teko_iterations_study(), operation_cost_study(),
      step_cost_study(),
  };
  static const NamedList<StudyEntry> list("study", entries);
  return list;
}

}  // namespace traceraft
