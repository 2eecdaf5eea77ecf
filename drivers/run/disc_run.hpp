// A run of the model of discs.
#pragma once

#include <memory>
#include <optional>

#include "drivers/run/checkpoint_store.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/run/run_schedule.hpp"
#include "kernel/discs/disc_system.hpp"
#include "kernel/simulation/run_loop.hpp"

namespace traceraft::run {

struct DiscSetup : RunSchedule {
  std::unique_ptr<discs::DiscSystem> system;  // at the beginning
};

// Throws InputError for anything that a run of discs could not start with; creates no files.
DiscSetup build_disc_run(const config::Configuration& configuration);

void print_disc_setup(const config::Configuration& configuration, const DiscSetup& run);

// Runs, or goes on from a checkpoint, until the end or a signal to stop. The folder then has the
// files that a run of the field has.
simulation::RunResult execute_disc_run(const config::Configuration& configuration, DiscSetup& run,
                                       const RunFolder& folder,
                                       const std::optional<Checkpoint>& checkpoint, bool quiet);

// The run of this folder from its beginning or where it stands, in silence.
simulation::RunResult carry_out_disc_run(const config::Configuration& configuration,
                                         const std::filesystem::path& path);

}  // namespace traceraft::run
