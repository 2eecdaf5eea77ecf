#include <CLI/CLI.hpp>
#include <algorithm>

#include "backends/posix/durable_file.hpp"
#include "backends/posix/folder_lock.hpp"
#include "backends/posix/own_files.hpp"
#include "backends/posix/process.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/config/number_checks.hpp"
#include "drivers/config/option_flags.hpp"
#include "drivers/ensemble/array_job.hpp"
#include "drivers/ensemble/ensemble_point.hpp"
#include "drivers/ensemble/ensemble_report.hpp"
#include "drivers/ensemble/histories_file.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/run/disc_run.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/run/run_mesh.hpp"
#include "drivers/run/run_setup.hpp"
#include "drivers/run/summary.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft::ensemble {
namespace {

namespace fs = std::filesystem;

struct EnsembleRequest {
  config::GivenValues flags;
  std::string config_file, out;
  int runs = 0, jobs = 0;        // 0: 10, or as many as there are; as many as processors
  std::int64_t first_seed = -1;  // −1: 1, or as it is
  std::int64_t member = -1;      // −1: all
  int members = 1;               // from that one on
  int threads = 0;               // of each run; 0: what the jobs leave
  bool array_job = false, quiet = false;
  ArrayLimits limits;  // of the array job
};

// The seed of a configuration file says nothing here: those that the program writes have one.
config::Configuration new_configuration(const EnsembleRequest& request, config::GivenValues file) {
  file.erase("seed");
  const config::Configuration configuration = run::run_configuration(file, request.flags);
  refuse_initial_state_but(configuration, {"noise", "band-limited", "discs"});
  return configuration;
}

// The configuration of an ensemble that goes on: its runs have to stay comparable.
config::Configuration known_configuration(const EnsembleFolder& folder,
                                          const EnsembleRequest& request,
                                          const config::GivenValues& file) {
  const config::Configuration known(config::read_config_file(folder.config()), {});
  if (file.empty() && request.flags.empty()) return known;
  const config::Configuration asked = new_configuration(request, file);
  if (config::numerical_identity(asked) != config::numerical_identity(known))
    throw InputError("--out: " + folder.path().string() +
                     " holds an ensemble of other runs; choose another folder, or give only --out "
                     "to continue it");
  for (const config::GivenValues* given : {&file, &request.flags})
    for (const auto& [name, value] : *given)
      if (name != "seed" &&
          config::config_lines(asked, {name}) != config::config_lines(known, {name}))
        throw InputError(value.where + ": the runs in " + folder.path().string() + " have '" +
                         known.text(name) + "'; new runs must have the same value");
  return known;
}

EnsemblePlan plan_of(const EnsembleRequest& request, const EnsembleFolder& folder) {
  EnsemblePlan plan;
  if (folder.started()) plan = folder.load();
  if (request.runs > 0 && request.runs < plan.runs && folder.started())
    throw InputError("--runs: " + folder.path().string() + " holds " + std::to_string(plan.runs) +
                     " runs already; the number can only grow");
  if (request.runs > 0) plan.runs = request.runs;
  if (request.first_seed >= 0) {
    const auto first = static_cast<std::uint64_t>(request.first_seed);
    if (folder.started() && first != plan.first_seed)
      throw InputError("--first-seed: " + folder.path().string() + " begins with seed " +
                       std::to_string(plan.first_seed));
    plan.first_seed = first;
  }
  if (static_cast<long double>(plan.last_seed()) > config::kLargestSeed)
    throw InputError("--first-seed: the last of " + std::to_string(plan.runs) + " runs has seed " +
                     std::to_string(plan.last_seed()) + " (allowed: up to " +
                     format_number(config::kLargestSeed) + ")");
  return plan;
}

// One after the other. A run that fails leaves the others alone; what stops one stops all.
int some_members(const EnsembleRequest& request, const EnsembleFolder& folder,
                 const EnsemblePlan& plan) {
  const auto first = static_cast<std::uint64_t>(request.member);
  if (first < plan.first_seed || first > plan.last_seed())
    throw InputError("--member: " + std::to_string(first) +
                     " is not in this ensemble (allowed: " + std::to_string(plan.first_seed) +
                     " to " + std::to_string(plan.last_seed()) + ")");
  const std::uint64_t left = plan.last_seed() - first + 1;
  const auto members = static_cast<std::uint64_t>(request.members);
  int code = drivers::kSuccess;
  for (std::uint64_t k = 0; k < std::min(members, left); ++k) {
    const int end = run_member(folder, first + k, std::max(1, request.threads), request.quiet);
    if (end != drivers::kSuccess) code = end;
    if (end == drivers::kInterrupted || posix::stop_requested()) return drivers::kInterrupted;
  }
  return code;
}

int carry_out(const EnsembleRequest& request, const EnsembleFolder& folder,
              const EnsemblePlan& plan, const config::Configuration& configuration) {
  const jobs::Jobs jobs = jobs::jobs_of(request.jobs, request.threads);
  if (!request.quiet)
    text::say("%d runs, %d at a time with %d thread%s each\nfolder %s\n\n", plan.runs,
              jobs.at_a_time, jobs.threads, jobs.threads == 1 ? "" : "s", folder.path());
  const double t_end = configuration.options().t_end;
  EnsembleEnd end = run_members(plan, folder, jobs, t_end, request.quiet);
  const FinishedMembers finished = finished_members(folder, configuration);
  end.failures.insert(end.failures.end(), finished.damaged.begin(), finished.damaged.end());
  for (const MemberFailure& failure : end.failures)
    text::say_error("the run of seed " + std::to_string(failure.seed) + " failed: " + failure.why);
  if (end.stopped) {
    if (!request.quiet)
      text::say("continue with: traceraft ensemble --out %s\n",
                text::in_shell(folder.path().string()));
    return drivers::kInterrupted;
  }
  const std::vector<observations::History>& runs = finished.histories;
  if (runs.empty()) return drivers::kNumericalFailure;
  const EnsembleSummary summary = summarise(runs);
  write_histories(folder.path() / kHistoriesFile, finished.seeds, runs, summary.times);
  const std::string missing = write_ensemble(folder, configuration, summary, end, request.quiet);
  if (!request.quiet) {
    if (!missing.empty()) text::say("\nmissing charts: %s\n", missing);
    text::say("\nopen next: %s\n", (folder.path() / "ensemble.html"));
  }
  return end.failures.empty() ? drivers::kSuccess : drivers::kNumericalFailure;
}

void write_array_job(const EnsembleRequest& request, const EnsembleFolder& folder,
                     const EnsemblePlan& plan, const config::Configuration& configuration) {
  const fs::path script = folder.path() / "array-job.sh";
  const ArrayTask task = array_task(configuration, plan, request.limits);
  posix::write_durably(script, array_job_script(folder, plan, task, request.limits));
  if (request.quiet) return;
  text::say(
      "%d tasks of 2 processors, %d GB and at most %d h each: see the #SBATCH lines of the "
      "script\n",
      task.tasks, task.gigabytes, task.hours);
  if (task.runs > 1)
    text::say("each task carries out %d runs, one after the other, because of --array-tasks %d\n",
              task.runs, request.limits.most_tasks);
  text::say("submit it with: sbatch %s\n", text::in_shell(script.string()));
}

// A script holds paths from the root, which no argument names.
void refuse_unwritable_path(const EnsembleFolder& folder) {
  const std::string path = fs::absolute(folder.path()).string();
  if (text::in_comment(path) != path)
    throw InputError(
        "--array-job: the path of the folder contains a control character, such as a "
        "line break, that no shell script can hold: " +
        path);
}

// Builds a first run, which may refuse the configuration.
std::string resolution_of(const config::Configuration& configuration) {
  if (run::is_of_discs(configuration)) {
    (void)run::build_disc_run(configuration);
    return "model of discs";
  }
  return run::resolution_text(configuration, run::build_run(configuration));
}

int run_ensemble(const EnsembleRequest& request) {
  posix::catch_stop_signals();
  const config::GivenValues file = config::read_config_file(request.config_file);
  const bool goes_on = !request.out.empty() && EnsembleFolder(request.out).started();
  if (request.member >= 0) {
    if (!goes_on) throw InputError("--member: --out must name an existing ensemble");
    return some_members(request, EnsembleFolder(request.out), EnsembleFolder(request.out).load());
  }
  if (!goes_on && !request.out.empty()) {
    run::refuse_foreign_folder(request.out, {EnsembleFolder(request.out).plan_file().filename()});
    EnsembleFolder(request.out).refuse_other_plan();
    if (file.empty() && request.flags.empty())  // a folder that is mistyped would take hours
      throw InputError("--out: " + request.out +
                       " holds no ensemble; a new one needs a model, as in --case guv-3to1");
  }
  const config::Configuration configuration =
      goes_on ? known_configuration(EnsembleFolder(request.out), request, file)
              : new_configuration(request, file);
  const EnsembleFolder folder(
      request.out.empty() ? run::first_free_folder("ensemble-" + configuration.options().case_name)
                          : request.out);
  if (request.array_job) refuse_unwritable_path(folder);
  const EnsemblePlan plan = plan_of(request, folder);
  const std::string resolution = goes_on ? "" : resolution_of(configuration);  // or refuses it
  fs::create_directories(folder.path());
  const posix::FolderLock lock(folder.path());
  if (!goes_on && folder.started()) run::refuse_begun(folder.path());
  folder.save(plan);
  posix::make_inner_folder(folder.path() / "runs");
  if (!resolution.empty() && !request.quiet)
    text::say("case %s, %s\n", configuration.options().case_name, resolution);
  if (!goes_on) posix::write_durably(folder.config(), config::config_text(configuration));
  if (!request.array_job) return carry_out(request, folder, plan, configuration);
  write_array_job(request, folder, plan, configuration);
  return drivers::kSuccess;
}

void add_array_options(CLI::App& app, EnsembleRequest& request) {
  CLI::Option* const job = app.add_flag(
      "--array-job", request.array_job,
      "run nothing, but write a script for SLURM's sbatch, with one or more runs per task");
  app.add_option("--array-tasks", request.limits.most_tasks,
                 "largest number of tasks that the cluster allows (MaxArraySize less 1); with more "
                 "runs than tasks, a task has several")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->needs(job);
  app.add_option("--array-throttle", request.limits.at_a_time,
                 "largest number of tasks at a time; default: no limit")
      ->check(CLI::Range(1, 100000))
      ->needs(job);
  CLI::Option* const member =
      app.add_option("--member", request.member, "carry out the run of this seed only (array jobs)")
          ->check(config::between(0, config::kLargestSeed));
  app.add_option("--members", request.members,
                 "number of runs to carry out, with seeds from --member on")
      ->check(CLI::Range(1, 100000))
      ->needs(member);
}

drivers::Action define_ensemble(CLI::App& app) {
  const auto request = std::make_shared<EnsembleRequest>();
  app.add_option("--config", request->config_file,
                 "TOML file of settings, with names of flags as keys")
      ->type_name("FILE");
  app.add_option("--out", request->out,
                 "new folder, or folder of an ensemble to continue or extend; default: "
                 "runs/ensemble-<case>-<number>")
      ->type_name("DIR");
  app.add_option("--runs", request->runs, "number of runs; default: 10")
      ->check(CLI::Range(1, kMostRuns));
  app.add_option("--first-seed", request->first_seed, "seed of the first run; default: 1")
      ->check(config::between(0, config::kLargestSeed));
  app.add_option("--jobs", request->jobs, "runs at a time; default: one for each processor")
      ->check(CLI::Range(1, 1024));
  app.add_option("--threads", request->threads, "threads of each run; default: processors / --jobs")
      ->check(CLI::Range(1, 64));
  add_array_options(app, *request);
  app.add_flag("--quiet", request->quiet, "print errors only");
  config::add_options(app, request->flags, [](const config::OptionSpec& spec) {
    return spec.name != "seed" && spec.name != "threads";
  });
  app.footer(
      "Give --out alone to continue an interrupted ensemble. Exit codes: 0 all runs are done,\n3 "
      "some runs failed (the others are gathered), 5 interrupted.\n"
      "Example: traceraft ensemble --case guv-3to1 --runs 10 --jobs 2");
  return [request] { return run_ensemble(*request); };
}

}  // namespace

drivers::Command ensemble_command() {
  return {"ensemble", "run one model with many seeds and gather the results",
          drivers::Ranks::starts_them, define_ensemble};
}

}  // namespace traceraft::ensemble
