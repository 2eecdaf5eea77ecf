// The cost of a run beside another one that differs in its mesh.
#pragma once

#include "drivers/config/configuration.hpp"

namespace traceraft::ensemble {

// Over those of a run of 128 cells. Nodes grow as cells², and the work as cells³: phase boundaries
// that are narrower with the mesh take more steps. Noise makes an adaptive mesh begin as large as a
// uniform one; the work is a tenth (docs/results.md). Other times, tolerances and methods do not
// enter.
inline double relative_memory(const config::Configuration& configuration) {
  const double finer = static_cast<double>(configuration.options().cells) / 128;
  return finer * finer;
}
inline double relative_work(const config::Configuration& configuration) {
  const double share = configuration.options().mesh == "adaptive" ? 0.1 : 1;
  return share * relative_memory(configuration) *
         static_cast<double>(configuration.options().cells) / 128;
}

}  // namespace traceraft::ensemble
