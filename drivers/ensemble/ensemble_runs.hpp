// Carries out the runs of an ensemble, each a process of its own.
#pragma once

#include <string>
#include <vector>

#include "drivers/ensemble/ensemble_folder.hpp"
#include "drivers/jobs/pending_jobs.hpp"

namespace traceraft::ensemble {

struct EnsembleEnd {
  bool stopped = false;                 // there is more to do
  std::vector<MemberFailure> failures;  // of members that will not end, in the order of the seeds
};

// Does what the ensemble still lacks. A run that fails leaves the others alone. `t_end`: of the
// runs, in the units of their files, for the progress shown. Throws IoError for what no run is to
// blame for.
EnsembleEnd run_members(const EnsemblePlan& plan, const EnsembleFolder& folder,
                        const jobs::Jobs& jobs, double t_end, bool quiet);

// One member alone, for the tasks of an array job. Returns the exit code of its run.
int run_member(const EnsembleFolder& folder, std::uint64_t seed, int threads, bool quiet);

}  // namespace traceraft::ensemble
