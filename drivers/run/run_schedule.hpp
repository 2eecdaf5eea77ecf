// When a run ends, and when it gives results.
#pragma once

#include <vector>

#include "drivers/config/configuration.hpp"
#include "kernel/physics/units.hpp"

namespace traceraft::run {

struct RunSchedule {
  physics::Units units;
  double t_end = 0;                     // units of R²/D, as below
  std::vector<double> output_times;     // ascending, within [0, t_end]
  std::vector<double> output_labels;    // the same as the user wrote them, in the user's units
  std::vector<double> repeated_labels;  // those that were asked for more than once

  // The place of an output time in the lists.
  std::size_t output_index(double t) const;
};

// Throws InputError for times out of range.
RunSchedule run_schedule(const config::Configuration& configuration);

}  // namespace traceraft::run
