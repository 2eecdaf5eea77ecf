#include "drivers/run/run_schedule.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/run/checked_options.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft::run {
namespace {

// In the user's units, ascending.
std::vector<double> asked_times(const config::Configuration& configuration) {
  constexpr int kDefaultTimes = 16;
  const double end = configuration.options().t_end;
  std::vector<double> times = configuration.options().output_times;
  if (times.empty()) {
    times.push_back(0);
    for (int i = 1; i <= kDefaultTimes; ++i)  // four decades, the end last
      times.push_back(end * std::pow(10.0, 4.0 * (i - kDefaultTimes) / kDefaultTimes));
  }
  std::sort(times.begin(), times.end());
  if (times.back() > end)
    throw InputError(configuration.where(&config::RunOptions::output_times) + ": " +
                     format_number(times.back()) + " is after the end of the run, " +
                     format_number(configuration.options().t_end));
  return times;
}

}  // namespace

std::size_t RunSchedule::output_index(double t) const {
  return static_cast<std::size_t>(std::lower_bound(output_times.begin(), output_times.end(), t) -
                                  output_times.begin());
}

RunSchedule run_schedule(const config::Configuration& configuration) {
  refuse_times_out_of_range(configuration);
  RunSchedule run;
  run.units = configuration.units();
  run.t_end = configuration.options().t_end / run.units.time();
  for (const double label : asked_times(configuration)) {
    const double t = std::min(label / run.units.time(), run.t_end);
    if (!run.output_times.empty() && t == run.output_times.back()) {
      if (run.repeated_labels.empty() || run.repeated_labels.back() != label)
        run.repeated_labels.push_back(label);
      continue;
    }
    run.output_labels.push_back(label);
    run.output_times.push_back(t);
  }
  return run;
}

}  // namespace traceraft::run
