#include "drivers/ensemble/ensemble_point.hpp"

#include "backends/posix/durable_file.hpp"
#include "drivers/config/config_file.hpp"

namespace traceraft {

PointEnd run_point(const std::filesystem::path& path, const Configuration& configuration,
                   const PointRequest& request) {
  const EnsembleFolder folder(path);
  EnsemblePlan plan;
  plan.runs = request.runs;
  std::filesystem::create_directories(path / "runs");
  if (!folder.started()) write_durably(folder.config(), config_text(configuration));
  folder.save(plan);
  const EnsembleEnd end = work_off(plan, folder, jobs_of(request.jobs, 0),
                                   configuration.number("t-end"), request.quiet);
  const Units units = configuration.units();
  PointEnd result{end.stopped, end.failures, finished_histories(folder, plan, units.length())};
  for (History& run : result.runs)
    for (double& t : run.time) t /= units.time();
  return result;
}

}  // namespace traceraft
