#include "drivers/ensemble/ensemble_point.hpp"

#include <algorithm>

#include "backends/posix/durable_file.hpp"
#include "backends/posix/own_files.hpp"
#include "drivers/config/config_file.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::ensemble {

config::GivenValues settings_until(const config::Configuration& model, double t_end) {
  config::GivenValues given;
  const auto set = [&](const std::string& option, const std::string& text) {
    given[option] = {text, "--" + option};
  };
  for (const config::OptionSpec& spec : config::run_options())
    if (spec.numerical && spec.name != "seed" && !model.text(spec.name).empty())
      set(spec.name, model.text(spec.name));
  set("t-end", format_number(t_end));
  set("output-times", format_number(t_end));
  set("fields", "false");
  return given;
}

void refuse_initial_state_but(const config::Configuration& model,
                              const std::vector<std::string>& random) {
  if (std::count(random.begin(), random.end(),
                 split_named_arguments(model.options().initial).name) == 0)
    throw InputError(model.where(&config::RunOptions::initial) +
                     ": runs differ in their initial state; choose " + joined(random, " or "));
}

void refuse_without_noise(const config::Configuration& model) {
  refuse_initial_state_but(model, {"noise", "discs"});
}

namespace {

// A plan that cannot be read says nothing that the one at hand does not.
bool holds(const EnsembleFolder& folder, const EnsemblePlan& plan) {
  try {
    return folder.started() && folder.load() == plan;
  } catch (const InputError&) {
    return false;
  } catch (const DamagedFile&) {
    return false;
  }
}

}  // namespace

PointEnd run_point(const std::filesystem::path& path, const config::Configuration& configuration,
                   const PointRequest& request) {
  const EnsembleFolder folder(path);
  EnsemblePlan plan;
  plan.runs = request.runs;
  posix::make_inner_folder(path / "runs");
  // Others may read what is there already.
  if (!holds(folder, plan)) folder.save(plan);
  if (!std::filesystem::exists(folder.config()))
    posix::write_durably(folder.config(), config::config_text(configuration));
  const double t_end = configuration.options().t_end;
  const EnsembleEnd end =
      run_members(plan, folder, jobs::jobs_of(request.jobs, request.threads), t_end, request.quiet);
  for (const MemberFailure& failure : end.failures)
    if (failure.locked)
      throw InputError(
          folder.run_of(failure.seed).string() +
          " is in use by another process; wait until it ends, then give the same command");
  const physics::Units units = configuration.units();
  FinishedMembers finished = finished_members(folder, configuration);
  PointEnd result{end.stopped, end.failures, std::move(finished.histories),
                  std::move(finished.seeds)};
  result.failures.insert(result.failures.end(), finished.damaged.begin(), finished.damaged.end());
  for (observations::History& run : result.runs)
    for (double& t : run.time) t /= units.time();
  return result;
}

void keep_common_seeds(std::vector<PointEnd>& ends) {
  const auto has = [](const PointEnd& end, std::uint64_t seed) {
    return std::find(end.seeds.begin(), end.seeds.end(), seed) != end.seeds.end();
  };
  const std::vector<PointEnd> all = ends;
  for (PointEnd& end : ends) {
    PointEnd kept{end.stopped, end.failures, {}, {}};
    for (std::size_t k = 0; k < end.seeds.size(); ++k) {
      const std::uint64_t seed = end.seeds[k];
      if (!std::all_of(all.begin(), all.end(), [&](const PointEnd& e) { return has(e, seed); }))
        continue;
      kept.runs.push_back(end.runs[k]);
      kept.seeds.push_back(seed);
    }
    end = std::move(kept);
  }
}

}  // namespace traceraft::ensemble
