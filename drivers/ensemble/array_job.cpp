#include "drivers/ensemble/array_job.hpp"

#include "backends/posix/child.hpp"

namespace traceraft {
namespace {

// One word for the shell, whatever is in it.
std::string shell_word(const std::string& text) {
  std::string word = "'";
  for (const char ch : text) word += ch == '\'' ? "'\\''" : std::string(1, ch);
  return word + "'";
}

}  // namespace

std::string array_job_script(const EnsembleFolder& folder, const EnsemblePlan& plan) {
  const std::string path = std::filesystem::absolute(folder.path()).lexically_normal().string();
  const std::string program = shell_word(own_path()) + " ensemble --out " + shell_word(path);
  return "#!/bin/sh\n"
         "#SBATCH --job-name=traceraft\n"
         // Clusters limit the index, seeds may be anything.
         "#SBATCH --array=0-" +
         std::to_string(plan.runs - 1) +
         "\n"
         "#SBATCH --cpus-per-task=2\n"
         "#SBATCH --mem=4G\n"
         "#SBATCH --time=04:00:00\n"
         "#SBATCH --signal=B:TERM@60\n"
         "# A task that is stopped or killed goes on where it was when it is submitted again.\n"
         "# When all are done: " +
         program +
         "\n"
         "exec " +
         program + " --member \"$((" + std::to_string(plan.first_seed) +
         " + SLURM_ARRAY_TASK_ID))\" --threads \"${SLURM_CPUS_PER_TASK:-1}\"\n";
}

}  // namespace traceraft
