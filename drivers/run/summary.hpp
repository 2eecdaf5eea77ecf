// The end of a run: summary.json for programs, a table for people. For the first rank: nothing here
// is collective. Cost and memory are those of all ranks.
#pragma once

#include <string>

#include "drivers/input/json_file.hpp"
#include "drivers/run/checkpoint_store.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/run/run_numbers.hpp"
#include "drivers/run/run_setup.hpp"
#include "kernel/simulation/run_loop.hpp"

namespace traceraft::run {

// The member of summary.json that holds configuration_checksum.
inline constexpr char kConfiguration[] = "configuration";
// The checksum of the options that change numbers.
std::string configuration_checksum(const config::Configuration& configuration);

// The exit code of the program that has carried out such a run.
int exit_code(const simulation::RunResult& result);

input::Json summary_json(const config::Configuration& configuration, const RunTotals& totals,
                         const simulation::RunResult& result, bool decay_promised,
                         const TableExtents& tables);

// How well the mesh resolves the phase boundary, and a warning if it does not.
std::string resolution_text(const config::Configuration& configuration, const RunSetup& run);

void print_setup(const config::Configuration& configuration, const RunSetup& run);
void print_summary(const config::Configuration& configuration, const RunSetup& run,
                   const simulation::RunState& state, const simulation::RunResult& result,
                   const RunCost& cost, double memory_mb, const RunFolder& folder);

// Lines of such a report: a label and a value.
void print_line(const char* label, const std::string& value);
void print_physics(const config::Configuration& configuration, const physics::Units& units);
void print_units(const RunSchedule& run);
// The parts of it that every model has: the end, rafts, perimeter; cost and what to open next.
void print_end(const RunTotals& totals, const simulation::RunResult& result);
void print_cost(const RunTotals& totals, const RunFolder& folder);

}  // namespace traceraft::run
