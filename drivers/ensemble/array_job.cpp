#include "drivers/ensemble/array_job.hpp"

#include <algorithm>
#include <cmath>

#include "backends/posix/child.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/ensemble/run_cost.hpp"
#include "drivers/text/encoders.hpp"

namespace traceraft::ensemble {

ArrayTask array_task(const config::Configuration& configuration, const EnsemblePlan& plan,
                     const ArrayLimits& limits) {
  // The memory and time of a run of guv-2to1, 128 cells, on one processor: docs/results.md.
  constexpr double kGigabytes = 0.45, kHours = 0.25, kSpare = 4;
  const auto shares = [](int all, int each) { return (all + each - 1) / each; };
  const int runs = shares(plan.runs, limits.most_tasks);
  const double hours = kSpare * kHours * std::max(1.0, relative_work(configuration));
  return {static_cast<int>(
              std::ceil(kSpare * kGigabytes * std::max(1.0, relative_memory(configuration)))),
          static_cast<int>(std::ceil(runs * hours)), shares(plan.runs, runs), runs};
}

std::string array_job_script(const EnsembleFolder& folder, const EnsemblePlan& plan,
                             const ArrayTask& task, const ArrayLimits& limits) {
  const std::string path = std::filesystem::absolute(folder.path()).lexically_normal().string();
  const std::string program =
      text::in_shell(posix::own_path()) + " ensemble --out " + text::in_shell(path);
  const std::string throttle = limits.at_a_time > 0 ? "%" + std::to_string(limits.at_a_time) : "";
  const std::string each = std::to_string(task.runs), index = "SLURM_ARRAY_TASK_ID";
  const std::string offset = task.runs > 1 ? each + " * " + index : index;
  return "#!/bin/sh\n"
         "#SBATCH --job-name=traceraft\n"
         // Clusters limit the index, seeds may be anything.
         "#SBATCH --array=0-" +
         std::to_string(task.tasks - 1) + throttle +
         "\n"
         "#SBATCH --cpus-per-task=2\n"
         "#SBATCH --mem=" +
         std::to_string(task.gigabytes) +
         "G\n"
         "#SBATCH --time=" +
         std::to_string(task.hours) +
         ":00:00\n"
         "#SBATCH --signal=B:TERM@60\n"
         "# Submit the script again to continue tasks that were stopped or killed.\n"
         "# When all tasks are done: " +
         text::in_comment(program) +
         "\n"
         "exec " +
         program + " --member \"$((" + std::to_string(plan.first_seed) + " + " + offset + "))\"" +
         (task.runs > 1 ? " --members " + each : "") + " --threads \"${SLURM_CPUS_PER_TASK:-1}\"\n";
}

}  // namespace traceraft::ensemble
