#include "verification/studies.hpp"

namespace traceraft {

const NamedList<StudyEntry>& studies() {
  static const NamedList<StudyEntry> list("study", {
                                                       mesh_convergence_study(),
                                                       time_order_study(),
                                                   });
  return list;
}

}  // namespace traceraft
