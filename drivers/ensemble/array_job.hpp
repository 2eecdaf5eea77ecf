// An ensemble on a cluster: an array job of SLURM, a task per run.
#pragma once

#include <string>

#include "drivers/config/configuration.hpp"
#include "drivers/ensemble/ensemble_folder.hpp"

namespace traceraft {

// What a task asks for: four times what the runs of 128 cells in docs/results.md took, and more for
// finer meshes, as their number of nodes and the work of a run grow.
struct ArrayTask {
  int gigabytes, hours;
};
ArrayTask array_task(const Configuration& configuration);

// The text of a script for sbatch. Each task carries out, or goes on with, the run of its seed with
// as many threads as it is given processors; afterwards the ensemble is gathered by the command
// that a comment in the script names.
std::string array_job_script(const EnsembleFolder& folder, const EnsemblePlan& plan,
                             const ArrayTask& task);

}  // namespace traceraft
