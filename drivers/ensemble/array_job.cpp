#include "drivers/ensemble/array_job.hpp"

#include <algorithm>
#include <cmath>

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

ArrayTask array_task(const Configuration& configuration) {
  constexpr double kCells = 128, kGigabytes = 0.45, kHours = 0.25;  // docs/results.md
  constexpr double kSpare = 4;
  const double finer = configuration.number("cells") / kCells;
  return {static_cast<int>(std::ceil(kSpare * kGigabytes * std::max(1.0, finer * finer))),
          static_cast<int>(std::ceil(kSpare * kHours * std::max(1.0, finer * finer * finer)))};
}

std::string array_job_script(const EnsembleFolder& folder, const EnsemblePlan& plan,
                             const ArrayTask& task) {
  const std::string path = std::filesystem::absolute(folder.path()).lexically_normal().string();
  const std::string program = shell_word(own_path()) + " ensemble --out " + shell_word(path);
  return "#!/bin/sh\n"
         "#SBATCH --job-name=traceraft\n"
         // Clusters limit the index, seeds may be anything.
         "#SBATCH --array=0-" +
         std::to_string(plan.runs - 1) +
         "\n"
         "#SBATCH --cpus-per-task=2\n"
         "#SBATCH --mem=" +
         std::to_string(task.gigabytes) +
         "G\n"
         "#SBATCH --time=" +
         std::to_string(task.hours) +
         ":00:00\n"
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
