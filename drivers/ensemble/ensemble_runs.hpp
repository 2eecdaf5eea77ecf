// Carries out the runs of an ensemble, each a process of its own.
#pragma once

#include <string>
#include <vector>

#include "drivers/ensemble/ensemble_folder.hpp"

namespace traceraft {

struct EnsembleEnd {
  bool stopped = false;                 // there is more to do
  std::vector<MemberFailure> failures;  // of members that will not end, in the order of the seeds
};

struct Jobs {
  int at_a_time, threads;  // threads of each run
};
// 0: as many as there are processors, and threads as those leave.
Jobs jobs_of(int at_a_time, int threads);

// Does what the ensemble still lacks. A run that fails
// leaves the others alone. `t_end`: of the runs, in the units of their files, for the progress
// shown. Throws IoError for what no run is to blame for.
EnsembleEnd work_off(const EnsemblePlan& plan, const EnsembleFolder& folder, const Jobs& jobs,
                     double t_end, bool quiet);

// One member alone, for the tasks of an array job. Returns the exit code of its run.
int run_member(const EnsembleFolder& folder, std::uint64_t seed, int threads, bool quiet);

}  // namespace traceraft
