#include <cstdio>
#include <optional>
#include <sstream>

#include "backends/posix/process.hpp"
#include "backends/ranks.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/run/progress.hpp"
#include "drivers/run/run_outputs.hpp"
#include "drivers/run/summary.hpp"

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

// Runs or goes on with a run, from a checkpoint if there is one. On every rank; `quiet` on all but
// the first, which alone has the checkpoint.
int carry_out(const Configuration& configuration, RunSetup& run, const RunFolder& folder,
              const std::optional<Checkpoint>& checkpoint, bool quiet) {
  const bool root = run.ranks->root();
  catch_stop_signals();
  ignore_file_size_signal();
  RunState state{*run.integrator, {}, 0, {}};
  std::optional<TableWriter> tables;
  if (root)
    tables.emplace(folder, run, checkpoint ? checkpoint->tables : decltype(Checkpoint::tables){});
  FieldWriter fields(folder, run);
  CheckpointWriter checkpoints(
      folder, run, root ? &*tables : nullptr, numerical_identity(configuration),
      configuration.number("checkpoint-interval"), checkpoint ? checkpoint->cost : RunCost{});
  Progress progress(run, quiet);
  std::vector<RunListener*> listeners;
  if (root) listeners.push_back(&*tables);
  if (configuration.flag("fields")) listeners.push_back(&fields);
  listeners.push_back(&checkpoints);
  if (root) listeners.push_back(&progress);

  RunResult result{RunEnd::finished, ""};
  if (run.ranks->any(checkpoint.has_value())) {
    std::istringstream saved(checkpoint ? checkpoint->state : "");
    state.load(CheckpointIn(saved, run.space->order));
  } else {
    if (Status status = start_run(run); !status.ok()) result = {RunEnd::failed, status.why};
    if (result.end != RunEnd::failed) begin_run(state, *run.observer, run.output_times, listeners);
  }
  if (result.end != RunEnd::failed)
    result = continue_run(state, *run.observer, run.t_end, run.output_times, listeners,
                          [&] { return run.ranks->any(stop_requested()); });
  progress.finish();
  if (run.integrator->statistics().steps > 0) checkpoints.write(state);
  const RunCost cost = checkpoints.cost();
  const double memory = run.ranks->sum(peak_memory_mb());
  if (root)
    write_durably(folder.summary(), summary_json(configuration, run, state, result, cost, memory));
  if (!quiet) print_summary(configuration, run, state, result, cost, memory, folder);
  if (result.end == RunEnd::stopped && !quiet)
    std::printf("  go on with             traceraft resume %s\n", folder.path.c_str());
  if (result.end == RunEnd::failed && root)
    std::fprintf(stderr, "traceraft: numerical failure at t = %g: %s\n",
                 state.row.t * run.units.time(), result.why.c_str());
  return exit_code(result);
}

// The checkpoint to go on from, if there is one. Of the first rank.
std::optional<Checkpoint> last_checkpoint(const RunFolder& folder,
                                          const Configuration& configuration) {
  const CheckpointStore store(folder.checkpoints());
  if (store.empty()) return std::nullopt;
  Checkpoint checkpoint = store.newest();
  if (checkpoint.configuration != numerical_identity(configuration))
    throw InputError(folder.config().string() +
                     " is not what the checkpoint was written with; restore it, or start a new "
                     "run with --initial restart:" +
                     folder.path.string());
  return checkpoint;
}

}  // namespace

int run_command(const RunRequest& request) {
  const GivenValues file = read_config_file(request.config_file);
  const Configuration configuration(file, request.flags);
  RunSetup run = build_run(configuration, InitialState::build);
  const bool quiet = request.quiet || !run.ranks->root();
  if (!quiet) print_setup(configuration, run);
  if (request.validate) {
    if (run.ranks->root()) std::printf("everything is valid; nothing was run\n");
    return kSuccess;
  }
  const RunFolder folder =
      shared_folder(*run.ranks, [&] { return create_run_folder(request.out, configuration); });
  if (!quiet) std::printf("  %-22s %s\n\n", "folder", folder.path.c_str());
  return carry_out(configuration, run, folder, std::nullopt, quiet);
}

int resume_command(const ResumeRequest& request) {
  const std::shared_ptr<const Communicator> ranks = world();
  const RunFolder folder = shared_folder(*ranks, [&] { return open_run_folder(request.folder); });
  const Configuration configuration(read_config_file(folder.config()), request.flags);
  std::optional<Checkpoint> checkpoint;
  if (ranks->root()) checkpoint = last_checkpoint(folder, configuration);
  RunSetup run =
      build_run(configuration, ranks->any(checkpoint.has_value()) ? InitialState::from_checkpoint
                                                                  : InitialState::build);
  const bool quiet = request.quiet || !ranks->root();
  if (!quiet) {
    print_setup(configuration, run);
    std::printf("  %-22s %s from step %ld\n\n", "resumed", folder.path.c_str(),
                checkpoint ? checkpoint->step : 0L);
  }
  return carry_out(configuration, run, folder, checkpoint, quiet);
}

}  // namespace traceraft
