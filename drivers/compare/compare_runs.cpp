#include "drivers/compare/compare_runs.hpp"

#include <unistd.h>

#include <cstdio>
#include <functional>

#include "backends/list.hpp"
#include "backends/posix/durable_file.hpp"
#include "backends/posix/folder_lock.hpp"
#include "backends/posix/own_files.hpp"
#include "backends/posix/process.hpp"
#include "backends/zlib/checksum.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/jobs/program_run.hpp"
#include "drivers/output/status_line.hpp"
#include "drivers/run/finished_run.hpp"
#include "drivers/run/run_folder.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;
using Tick = std::function<void()>;

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

// Another comparison may be at it: then its end is waited for.
WorkEnd compute(const Reference& reference, const ComparisonFolder& folder, const Tick& tick,
                std::string& why) {
  fs::create_directories(reference.folder.parent_path());
  while (!run_finished(reference.folder)) {
    const ProcessEnd end = run_program(reference_arguments(reference, folder),
                                       folder.path() / "reference.log", 1, 0, tick);
    if (end.was_stopped()) return WorkEnd::stopped;
    if (end.exit_code == kLocked) {
      tick();
      usleep(200000);
      continue;
    }
    if (end.exit_code == kNumericalFailure) {
      why = end.reason();
      return WorkEnd::reference_failed;
    }
    if (end.exit_code != kSuccess) throw IoError("the reference failed: " + end.reason());
  }
  return WorkEnd::done;
}

WorkEnd compute(const CompareJob& job, const ComparisonFolder& folder, double time_limit,
                const Tick& tick) {
  const fs::path run = folder.run_of(job);
  if (fs::exists(run)) {
    // What an interruption left: its times mean nothing. Unless a run that outlived its comparison
    // is still at it.
    const FolderLock lock(run);
    remove_own_folder(run, files_of_a_run());
  }
  std::vector<std::string> arguments = {"run", "--config", folder.config().string()};
  arguments.insert(arguments.end(),
                   {"--integrator", job.integrator, "--linear-solver", job.linear_solver,
                    "--tolerance", format_number(job.tolerance)});
  arguments.insert(arguments.end(), {"--out", run.string(), "--no-fields", "--checkpoint-interval",
                                     "1e9", "--quiet"});
  if (job.ranks > 1) arguments.insert(arguments.end(), {"--threads", "1"});
  const ProcessEnd end = run_program(arguments, folder.log_of(job), job.ranks, time_limit, tick);
  if (end.out_of_time) {
    folder.record(job, {"stopped after " + format_number(time_limit) + " s", time_limit});
    return WorkEnd::done;
  }
  if (end.was_stopped()) return WorkEnd::stopped;
  if (!end.concerns_input()) throw IoError(job.name() + " could not run: " + end.reason());
  folder.record(job, {end.exit_code == kSuccess ? "" : end.reason(), 0});
  return WorkEnd::done;
}

}  // namespace

Reference reference_of(const ComparePlan& plan, const ComparisonFolder& folder,
                       const std::string& cache) {
  Reference reference;
  for (const char* option : {"initial-step", "min-step", "max-step"})
    reference.options[option] = {run_option(option).default_text, ""};
  const IntegratorEntry& ida = integrators().find("ida");
  for (const ParameterSpec& parameter : ida.parameters)
    reference.options[integrator_option(ida, parameter)] = {format_number(parameter.default_value),
                                                            ""};
  reference.options["integrator"] = {"ida", ""};
  reference.options["linear-solver"] = {"block", ""};
  reference.options["linear-tolerance"] = {kReferenceLinearTolerance, ""};
  reference.options["tolerance"] = {format_number(plan.reference()), ""};
  const std::string identity =
      numerical_identity(Configuration(read_config_file(folder.config()), reference.options));
  char name[32];
  std::snprintf(name, sizeof name, "%08x-%08x", crc32_of(identity + plan.program),
                plan.initial_state);
  reference.folder = fs::path(cache) / name;
  if (fs::exists(reference.folder / "config.toml") &&
      numerical_identity(Configuration(read_config_file(reference.folder / "config.toml"), {})) !=
          identity)
    throw InputError("--references: " + reference.folder.string() +
                     " holds another run of the same name; choose another folder");
  return reference;
}

WorkEnd work_off(const ComparePlan& plan, const ComparisonFolder& folder,
                 const Reference& reference, bool quiet, std::string& why) {
  const std::vector<CompareJob> jobs = jobs_of(plan);
  StatusLine line(quiet);
  const Stopwatch watch;
  long done = 0, total = static_cast<long>(jobs.size()) + 1, worked = 0;
  const auto tick_for = [&](const std::string& what) {
    return [&, what] {
      if (!line.due()) return;
      const double left = worked > 0 ? watch.seconds() / static_cast<double>(worked) *
                                           static_cast<double>(total - done)
                                     : 0;
      line.show(static_cast<double>(done) / static_cast<double>(total),
                std::to_string(done) + "/" + std::to_string(total) + "  " + what + "  " +
                    clock_text(watch.seconds()) + " elapsed" +
                    (left > 0 ? "  ~" + clock_text(left) + " left" : ""));
    };
  };
  WorkEnd end = WorkEnd::done;
  if (!run_finished(reference.folder)) {
    end = compute(reference, folder,
                  tick_for("reference: ida at " + format_number(plan.reference())), why);
    ++worked;
  }
  ++done;
  for (const CompareJob& job : jobs) {
    if (end == WorkEnd::done && stop_requested()) end = WorkEnd::stopped;
    if (end != WorkEnd::done) break;
    if (!folder.done(job, plan)) {
      end = compute(job, folder, plan.time_limit, tick_for(job.name()));
      ++worked;
    }
    ++done;
  }
  line.finish();
  return end;
}

}  // namespace traceraft
