// An ensemble on a cluster: an array job of SLURM, a task per run.
#pragma once

#include <string>

#include "drivers/config/configuration.hpp"
#include "drivers/ensemble/ensemble_folder.hpp"

namespace traceraft {

// What a task asks for: four times what the runs of the paper's cases took, and more for finer
// meshes; what else makes a run long, such as --t-end, is not known here.
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
