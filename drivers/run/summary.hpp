// The end of a run: summary.json for programs, a table for people. For the first rank: nothing here
// is collective. Cost and memory are those of all ranks.
#pragma once

#include <string>

#include "drivers/run/checkpoint_store.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/run/run_setup.hpp"
#include "kernel/simulation/run_loop.hpp"

namespace traceraft::run {

// The member of summary.json that holds configuration_checksum.
inline constexpr char kConfiguration[] = "configuration";
// The checksum of the options that change numbers.
std::string configuration_checksum(const config::Configuration& configuration);

std::string summary_json(const config::Configuration& configuration, const RunSetup& run,
                         const simulation::RunState& state, const simulation::RunResult& result,
                         const RunCost& cost, double memory_mb, const TableExtents& tables);

// How well the mesh resolves the phase boundary, and a warning if it does not.
std::string resolution_text(const config::Configuration& configuration, const RunSetup& run);

void print_setup(const config::Configuration& configuration, const RunSetup& run);
void print_summary(const config::Configuration& configuration, const RunSetup& run,
                   const simulation::RunState& state, const simulation::RunResult& result,
                   const RunCost& cost, double memory_mb, const RunFolder& folder);

}  // namespace traceraft::run
