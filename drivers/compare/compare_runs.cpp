#include "drivers/compare/compare_runs.hpp"

#include <cstdio>

#include "backends/list.hpp"
#include "backends/posix/durable_file.hpp"
#include "backends/posix/folder_lock.hpp"
#include "backends/posix/own_files.hpp"
#include "backends/zlib/checksum.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/jobs/pending_jobs.hpp"
#include "drivers/run/finished_run.hpp"
#include "drivers/run/run_folder.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft::compare {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> reference_arguments(const Reference& reference,
                                             const ComparisonFolder& folder) {
  if (fs::exists(reference.folder / "config.toml"))
    return {"resume", reference.folder.string(), "--quiet"};
  std::vector<std::string> arguments = {
      "run",         "--config", folder.config().string(), "--out", reference.folder.string(),
      "--no-fields", "--quiet"};
  for (const auto& [option, value] : reference.options) {
    arguments.push_back("--" + option);
    arguments.push_back(value.text);
  }
  return arguments;
}

// Nothing is wrong with the method or the model; the machine is to blame.
[[noreturn]] void blame_machine(const std::string& name, const jobs::ProcessEnd& end) {
  throw IoError(name + ": " + end.reason());
}

// Another comparison may be at it: then its end is waited for.
WorkEnd compute(const Reference& reference, const ComparisonFolder& folder, bool quiet,
                std::string& why) {
  fs::create_directories(reference.folder.parent_path());
  jobs::PendingJobs job;
  job.count = 1;
  job.kind = "reference";
  job.folder = folder.path();
  job.quiet = quiet;
  job.run = [&](std::size_t) {
    jobs::ProcessEnd end =
        jobs::run_program(reference_arguments(reference, folder), folder.path() / "reference.log");
    const bool known = end.exit_code == drivers::kSuccess ||
                       end.exit_code == drivers::kNumericalFailure ||
                       end.exit_code == drivers::kLocked || end.was_stopped();
    if (!known) blame_machine("the reference failed", end);
    return end;
  };
  job.name = [](std::size_t) { return std::string("the reference"); };
  while (!run::run_finished(reference.folder)) {
    const jobs::JobsEnd end = jobs::run_pending_jobs(job);
    if (end.stopped) return WorkEnd::stopped;
    if (end.failures.empty() || end.failures.front().locked) continue;
    why = end.failures.front().why;
    return WorkEnd::reference_failed;
  }
  return WorkEnd::done;
}

bool is_result(const jobs::ProcessEnd& end) {
  return end.out_of_time || (!end.was_stopped() && end.concerns_input());
}

// A result is recorded, a failure with its reason.
jobs::ProcessEnd compute(const CompareJob& job, const ComparisonFolder& folder, double time_limit) {
  const fs::path run = folder.run_of(job);
  if (fs::exists(run)) {
    // An interruption left this run, and its times mean nothing. The lock is for a run that
    // outlived its comparison and is still at it.
    const posix::FolderLock lock(run);
    posix::remove_own_folder(run, run::files_of_a_run());
  }
  std::vector<std::string> arguments = {"run", "--config", folder.config().string()};
  arguments.insert(arguments.end(),
                   {"--integrator", job.integrator, "--linear-solver", job.linear_solver,
                    "--tolerance", format_number(job.tolerance)});
  arguments.insert(arguments.end(), {"--out", run.string(), "--no-fields", "--checkpoint-interval",
                                     "1e9", "--quiet"});
  if (job.ranks > 1) arguments.insert(arguments.end(), {"--threads", "1"});
  jobs::ProcessEnd end = jobs::run_program(arguments, folder.log_of(job), job.ranks, time_limit);
  if (end.out_of_time)
    folder.record(job, {"stopped after " + format_number(time_limit) + " s", time_limit});
  else if (is_result(end))
    folder.record(job, {end.exit_code == drivers::kSuccess ? "" : end.reason(), 0});
  else if (!end.was_stopped())
    blame_machine(job.name() + " could not run", end);
  return end;
}

}  // namespace

Reference reference_of(const ComparePlan& plan, const ComparisonFolder& folder,
                       const std::string& cache) {
  Reference reference;
  for (const char* option : {"initial-step", "min-step", "max-step"})
    reference.options[option] = {config::run_option(option).default_text, ""};
  const backends::IntegratorEntry& ida = backends::integrators().find("ida");
  for (const ParameterSpec& parameter : ida.parameters)
    reference.options[config::method_option(ida.name, parameter)] = {
        format_number(parameter.default_value), ""};
  reference.options["integrator"] = {"ida", ""};
  reference.options["linear-solver"] = {"block", ""};
  reference.options["linear-tolerance"] = {kReferenceLinearTolerance, ""};
  reference.options["tolerance"] = {format_number(plan.reference()), ""};
  const std::string identity = config::numerical_identity(
      config::Configuration(config::read_config_file(folder.config()), reference.options));
  char name[32];
  std::snprintf(name, sizeof name, "%08x-%08x", zlib::crc32_of(identity + plan.program),
                plan.initial_state);
  reference.folder = fs::path(cache) / name;
  if (fs::exists(reference.folder / "config.toml") &&
      config::numerical_identity(config::Configuration(
          config::read_config_file(reference.folder / "config.toml"), {})) != identity)
    throw InputError("--references: " + reference.folder.string() +
                     " holds another run with the same name; choose another folder");
  return reference;
}

WorkEnd run_comparison(const ComparePlan& plan, const ComparisonFolder& folder,
                       const Reference& reference, bool quiet, std::string& why) {
  if (const WorkEnd end = compute(reference, folder, quiet, why); end != WorkEnd::done) return end;
  const std::vector<CompareJob> all = jobs_of(plan);
  std::vector<CompareJob> open;
  for (const CompareJob& job : all)
    if (!folder.done(job, plan)) open.push_back(job);
  jobs::PendingJobs jobs;
  jobs.count = open.size();
  jobs.before = all.size() - open.size();
  jobs.kind = "runs";
  jobs.folder = folder.path();
  jobs.quiet = quiet;
  jobs.run = [&](std::size_t k) {
    // The first repetition may have failed since the list was made: it is not repeated for its
    // time.
    return folder.done(open[k], plan) ? jobs::ProcessEnd{}
                                      : compute(open[k], folder, plan.time_limit);
  };
  jobs.name = [&](std::size_t k) { return open[k].name(); };
  jobs.success = is_result;
  return jobs::run_pending_jobs(jobs).stopped ? WorkEnd::stopped : WorkEnd::done;
}

}  // namespace traceraft::compare
