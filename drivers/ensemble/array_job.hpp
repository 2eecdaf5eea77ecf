// An ensemble on a cluster: an array job of SLURM, a task per run.
#pragma once

#include <string>

#include "drivers/config/configuration.hpp"
#include "drivers/ensemble/ensemble_folder.hpp"

namespace traceraft::ensemble {

// Clusters limit the index of a task, by default to 1000, and some the tasks at a time.
struct ArrayLimits {
  int most_tasks = 1000;
  int at_a_time = 0;  // 0: as many as the cluster likes
};

// A task asks for four times what the runs of the paper's cases took, and for more with finer
// meshes. Anything else that makes a run long, such as --t-end, is not known here.
struct ArrayTask {
  int gigabytes, hours;  // hours of all its runs
  int tasks, runs;       // how many there are; runs of each, one after the other
};
ArrayTask array_task(const config::Configuration& configuration, const EnsemblePlan& plan,
                     const ArrayLimits& limits);

// The text of a script for sbatch. Each task carries out, or goes on with, the runs of its seeds
// with as many threads as it is given processors; afterwards the ensemble is gathered by the
// command that a comment in the script names.
std::string array_job_script(const EnsembleFolder& folder, const EnsemblePlan& plan,
                             const ArrayTask& task, const ArrayLimits& limits);

}  // namespace traceraft::ensemble
