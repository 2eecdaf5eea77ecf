#include <optional>
#include <sstream>

#include "backends/posix/process.hpp"
#include "backends/ranks.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/config/option_flags.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/run/disc_run.hpp"
#include "drivers/run/memory_need.hpp"
#include "drivers/run/physical_model.hpp"
#include "drivers/run/progress.hpp"
#include "drivers/run/run_mesh.hpp"
#include "drivers/run/run_outputs.hpp"
#include "drivers/run/summary.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::run {
namespace {

constexpr char kNothingRun[] = "all settings are valid; nothing was run\n";

struct RunRequest {
  config::GivenValues flags;
  std::string config_file;  // "" for none
  std::string out;          // "" for the first free runs/<case>-N
  bool validate = false;    // stop after checking everything
  bool quiet = false;
};
struct ResumeRequest {
  std::string folder;
  config::GivenValues flags;  // options that do not change the numbers
  bool quiet = false;
};

void say_how_to_go_on(const RunFolder& folder) {
  text::say("  continue with          traceraft resume %s\n", text::in_shell(folder.path.string()));
}

void say_resumed(const RunFolder& folder, const std::optional<Checkpoint>& checkpoint) {
  if (checkpoint)
    text::say("  %-22s %s from step %ld\n\n", "resumed", folder.path, checkpoint->step);
  else
    text::say("  %-22s %s, which has no checkpoint; the run starts again\n\n", "restarted",
              folder.path);
}

// Runs or goes on with a run, from a checkpoint if there is one. On every rank; `quiet` on all but
// the first, which alone has the checkpoint.
int execute_run(const config::Configuration& configuration, RunSetup& run, const RunFolder& folder,
                const std::optional<Checkpoint>& checkpoint, bool quiet) {
  const bool root = run.ranks->root();
  posix::catch_stop_signals();
  simulation::RunState state{run, run.adaptation.get()};
  std::optional<RunTables> tables;
  if (root) tables.emplace(folder, run, checkpoint ? checkpoint->tables : TableExtents{});
  std::optional<TableWriter> rows;
  if (root) rows.emplace(*tables, run);
  FieldWriter fields(folder, run);
  CheckpointWriter checkpoints(
      folder, run, root ? &*tables : nullptr, config::numerical_identity(configuration),
      configuration.options().checkpoint_interval, checkpoint ? checkpoint->cost : RunCost{});
  Progress progress(run, quiet);
  std::vector<simulation::RunListener*> listeners;
  if (root) listeners.push_back(&*rows);
  if (configuration.options().fields) listeners.push_back(&fields);
  listeners.push_back(&checkpoints);
  if (root) listeners.push_back(&progress);

  simulation::RunResult result{simulation::RunEnd::finished, ""};
  if (run.ranks->any(checkpoint.has_value())) {
    std::istringstream saved(checkpoint ? checkpoint->state : "");
    state.load(CheckpointIn(saved, run.space->order));
  } else {
    if (Status status = start_run(run); !status.ok())
      result = {simulation::RunEnd::failed, status.why};
    if (result.end != simulation::RunEnd::failed)
      simulation::begin_run(state, run.output_times, listeners);
  }
  if (result.end != simulation::RunEnd::failed)
    result = simulation::continue_run(state, run.t_end, run.output_times, listeners,
                                      [&] { return run.ranks->any(posix::stop_requested()); });
  progress.finish();
  if (run.integrator->statistics().steps > 0) checkpoints.write(state);
  const RunCost cost = checkpoints.cost();
  const double memory = run.ranks->sum(posix::peak_memory_mb());
  if (root) {
    const observables::Observables& row = state.observables;
    const RunMoment end = moment_of(run, row, row.t * run.units.time());
    input::write_json(
        folder.summary(),
        summary_json(configuration, {end, state.monitor, ground_of(run), cost, memory}, result,
                     run.integrator->promises_energy_decay(), tables->extents_at_end(folder)));
  }
  if (!quiet) print_summary(configuration, run, state, result, cost, memory, folder);
  if (result.end == simulation::RunEnd::stopped && !quiet) say_how_to_go_on(folder);
  if (result.end == simulation::RunEnd::failed && root)
    text::say_error(
        formatted("numerical failure at t = %g: ", state.observables.t * run.units.time()) +
        result.why);
  return exit_code(result);
}

// A fine mesh takes its time before anything else is said.
void announce_fine_mesh(const config::Configuration& configuration) {
  if (!begins_finest(configuration)) return;
  const geometry::LevelSetPtr surface = surface_of(configuration);
  const double nodes = nodes_of_fine_mesh(*surface, configuration.options().cells);
  if (nodes == 0 || !backends::world()->root()) return;
  text::say("setting up a mesh of about %.2g million nodes\n", nodes / 1e6);
  text::flush_output();
}

// Before anything is set up or said.
void refuse_used_folder(const std::string& out) {
  if (out.empty()) return;
  (void)shared_folder(*backends::world(), [&] {
    refuse_before_lock(out);
    return RunFolder{out, nullptr};
  });
}

// Goes on from the checkpoint, if there is one.
int finish_disc_run(const config::Configuration& configuration, DiscSetup& run,
                    const RunFolder& folder, const std::optional<Checkpoint>& checkpoint,
                    bool quiet) {
  posix::catch_stop_signals();
  const simulation::RunResult result =
      execute_disc_run(configuration, run, folder, checkpoint, quiet);
  if (result.end == simulation::RunEnd::stopped && !quiet) say_how_to_go_on(folder);
  if (result.end == simulation::RunEnd::failed) text::say_error("numerical failure: " + result.why);
  return exit_code(result);
}

int run_discs(const RunRequest& request, const config::Configuration& configuration) {
  DiscSetup run = build_disc_run(configuration);
  if (!request.quiet) print_disc_setup(configuration, run);
  if (request.validate) {
    if (!request.quiet) text::say(kNothingRun);
    return drivers::kSuccess;
  }
  const RunFolder folder = create_run_folder(request.out, configuration);
  if (!request.quiet) text::say("  %-22s %s\n\n", "folder", folder.path);
  return finish_disc_run(configuration, run, folder, std::nullopt, request.quiet);
}

int run(const RunRequest& request) {
  const config::GivenValues file = config::read_config_file(request.config_file);
  posix::end_on_stop_signals(drivers::kInterrupted, "");  // before there are threads
  const config::Configuration configuration = run_configuration(file, request.flags);
  refuse_used_folder(request.out);
  if (is_of_discs(configuration)) return run_discs(request, configuration);
  if (!request.quiet) announce_fine_mesh(configuration);
  RunSetup run = build_run(configuration);
  const bool quiet = request.quiet || !run.ranks->root();
  if (!quiet) print_setup(configuration, run);
  if (request.validate) {
    if (!quiet) text::say(kNothingRun);
    return drivers::kSuccess;
  }
  const RunFolder folder =
      shared_folder(*run.ranks, [&] { return create_run_folder(request.out, configuration); });
  if (!quiet) text::say("  %-22s %s\n\n", "folder", folder.path);
  return execute_run(configuration, run, folder, std::nullopt, quiet);
}

int resume(const ResumeRequest& request) {
  if (request.folder.empty())
    throw InputError(
        "resume: the folder of a run is needed, as in traceraft resume runs/guv-2to1-1");
  posix::end_on_stop_signals(drivers::kInterrupted, "");  // before there are threads
  const std::shared_ptr<const Communicator> ranks = backends::world();
  const RunFolder folder = shared_folder(*ranks, [&] { return open_run_folder(request.folder); });
  const config::Configuration configuration(config::read_config_file(folder.config()),
                                            request.flags);
  std::optional<Checkpoint> checkpoint;
  if (ranks->root())
    checkpoint = last_checkpoint(folder.path, config::numerical_identity(configuration));
  if (is_of_discs(configuration)) {
    DiscSetup run = build_disc_run(configuration);
    if (!request.quiet) {
      print_disc_setup(configuration, run);
      say_resumed(folder, checkpoint);
    }
    return finish_disc_run(configuration, run, folder, checkpoint, request.quiet);
  }
  RunSetup run = build_run(configuration, {ranks->any(checkpoint.has_value()),
                                           checkpoint ? checkpoint->forest : std::vector<bool>()});
  const bool quiet = request.quiet || !ranks->root();
  if (!quiet) {
    print_setup(configuration, run);
    say_resumed(folder, checkpoint);
  }
  return execute_run(configuration, run, folder, checkpoint, quiet);
}

drivers::Action define_run(CLI::App& app) {
  const auto request = std::make_shared<RunRequest>();
  app.add_option("--config", request->config_file,
                 "TOML file of settings, with names of flags as keys")
      ->type_name("FILE");
  app.add_option("--out", request->out, "new folder of the run; default: runs/<case>-<number>")
      ->type_name("DIR");
  app.add_flag("--validate", request->validate,
               "check all settings and stop before the first step");
  app.add_flag("--quiet", request->quiet, "print errors only");
  config::add_options(app, request->flags, [](const config::OptionSpec&) { return true; });
  app.footer(
      "A flag overrides --config, which overrides the case, which overrides the defaults.\nExit "
      "codes: 0 success, 2 bad input, 3 numerical failure, 4 input/output,\n5 interrupted "
      "(checkpoint written), 6 folder in use.\n"
      "Example: traceraft run --case guv-2to1 --cells 64 --epsilon 0.1 --t-end 100");
  return [request] { return run(*request); };
}

drivers::Action define_resume(CLI::App& app) {
  const auto request = std::make_shared<ResumeRequest>();
  app.add_option("folder", request->folder, "folder of the run to continue")->type_name("DIR");
  app.add_flag("--quiet", request->quiet, "print errors only");
  config::add_options(app, request->flags,
                      [](const config::OptionSpec& spec) { return !spec.numerical; });
  return [request] { return resume(*request); };
}

}  // namespace

drivers::Command run_command() {
  return {"run", "run a simulation", drivers::Ranks::several, define_run};
}

drivers::Command resume_command() {
  return {"resume", "continue an interrupted run", drivers::Ranks::several, define_resume};
}

}  // namespace traceraft::run
