#include <cstdio>
#include <optional>
#include <sstream>

#include "backends/posix/process.hpp"
#include "drivers/commands.hpp"
#include "drivers/config_file.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/progress.hpp"
#include "drivers/run_outputs.hpp"
#include "drivers/summary.hpp"

namespace traceraft {
namespace {

int exit_code(const RunResult& result) {
  switch (result.end) {
    case RunEnd::finished:
      return kSuccess;
    case RunEnd::stopped:
      return kInterrupted;
    default:
      return kNumericalFailure;
  }
}

// Runs or goes on with a run, from a checkpoint if there is one.
int carry_out(const Configuration& configuration, RunSetup& run, const RunFolder& folder,
              const std::optional<Checkpoint>& checkpoint, bool quiet) {
  catch_stop_signals();
  ignore_file_size_signal();
  RunState state{*run.integrator, {}, 0, {}};
  TableWriter tables(folder, run, checkpoint ? checkpoint->tables : decltype(Checkpoint::tables){});
  FieldWriter fields(folder, run);
  CheckpointWriter checkpoints(folder, run, tables, numerical_identity(configuration),
                               configuration.number("checkpoint-interval"),
                               checkpoint ? checkpoint->cost : RunCost{});
  Progress progress(run, quiet);
  std::vector<RunListener*> listeners = {&tables};
  if (configuration.flag("fields")) listeners.push_back(&fields);
  listeners.insert(listeners.end(), {&checkpoints, &progress});

  RunResult result{RunEnd::finished, ""};
  if (checkpoint) {
    std::istringstream saved(checkpoint->state);
    state.load(saved);
  } else {
    if (Status status = start_run(run); !status.ok()) result = {RunEnd::failed, status.why};
    if (result.end != RunEnd::failed) begin_run(state, *run.observer, run.output_times, listeners);
  }
  if (result.end != RunEnd::failed)
    result =
        continue_run(state, *run.observer, run.t_end, run.output_times, listeners, stop_requested);
  progress.finish();
  if (run.integrator->statistics().steps > 0) checkpoints.write(state);
  const RunCost cost = checkpoints.cost();
  write_durably(folder.summary(), summary_json(configuration, run, state, result, cost));
  if (!quiet) print_summary(configuration, run, state, result, cost, folder);
  if (result.end == RunEnd::stopped && !quiet)
    std::printf("  go on with             traceraft resume %s\n", folder.path.c_str());
  if (result.end == RunEnd::failed)
    std::fprintf(stderr, "traceraft: numerical failure at t = %g: %s\n",
                 state.row.t * run.units.time(), result.why.c_str());
  return exit_code(result);
}

}  // namespace

int run_command(const RunRequest& request) {
  const GivenValues file = read_config_file(request.config_file);
  const Configuration configuration(file, request.flags);
  RunSetup run = build_run(configuration, InitialState::build);
  if (!request.quiet) print_setup(configuration, run);
  if (request.validate) {
    std::printf("everything is valid; nothing was run\n");
    return kSuccess;
  }
  const RunFolder folder = create_run_folder(request.out, configuration);
  if (!request.quiet) std::printf("  %-22s %s\n\n", "folder", folder.path.c_str());
  return carry_out(configuration, run, folder, std::nullopt, request.quiet);
}

int resume_command(const ResumeRequest& request) {
  const RunFolder folder = open_run_folder(request.folder);
  const Configuration configuration(read_config_file(folder.config()), request.flags);
  std::optional<Checkpoint> checkpoint;
  if (const CheckpointStore store(folder.checkpoints()); !store.empty()) {
    checkpoint = store.newest();
    if (checkpoint->configuration != numerical_identity(configuration))
      throw InputError(folder.config().string() +
                       " is not what the checkpoint was written with; restore it, or start a new "
                       "run with --initial restart:" +
                       folder.path.string());
  }
  RunSetup run =
      build_run(configuration, checkpoint ? InitialState::from_checkpoint : InitialState::build);
  if (!request.quiet) {
    print_setup(configuration, run);
    std::printf("  %-22s %s from step %ld\n\n", "resumed", folder.path.c_str(),
                checkpoint ? checkpoint->step : 0L);
  }
  return carry_out(configuration, run, folder, checkpoint, request.quiet);
}

}  // namespace traceraft
