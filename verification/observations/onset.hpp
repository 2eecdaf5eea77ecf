// Decomposition that begins later than the time zero of the measurements: a sample has to cool
// first, and how long that takes is seldom measured.
#pragma once

#include <optional>
#include <vector>

#include "verification/observations/comparison.hpp"

namespace traceraft::observations {

struct Onset {
  double delay;  // s
  bool at_end;   // a longer one might do better: it is as long as looks let it be
  std::vector<Agreement> agreements;  // with it
};

// The delay with which perimeters and numbers of rafts change most like those of the runs; none if
// a trend is left with any, or if there is none without it. It costs no simulation. Throws as
// compare_with_runs.
std::optional<Onset> onset_without_trend(const MeasuredVesicles& data,
                                         const std::vector<History>& runs);

}  // namespace traceraft::observations
