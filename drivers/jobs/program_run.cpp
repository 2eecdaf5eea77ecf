#include "drivers/jobs/program_run.hpp"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include "backends/posix/child.hpp"
#include "backends/posix/durable_file.hpp"
#include "backends/posix/own_files.hpp"
#include "backends/posix/process.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/run/finished_run.hpp"
#include "drivers/run/run_folder.hpp"

namespace traceraft::jobs {
namespace {

constexpr std::uint64_t kLargestLog = 1 << 24;

// mpirun of Open MPI; ranks give way to each other where there are more of them than processors.
std::vector<std::string> program_on(int ranks) {
  if (ranks == 1) return {posix::own_program()};
  std::vector<std::string> command = {
      "mpirun", "--quiet", "--oversubscribe",    "--mca", "mpi_yield_when_idle",
      "1",      "-np",     std::to_string(ranks)};
  if (posix::is_superuser()) command.push_back("--allow-run-as-root");
  command.push_back(posix::own_path());
  return command;
}

// A run and its log.
void remove_scratch(const std::filesystem::path& scratch) {
  if (!std::filesystem::exists(scratch)) return;
  std::vector<std::string> own = {"log"};
  for (const std::string& name : run::files_of_a_run()) own.push_back("run/" + name);
  posix::remove_own_folder(scratch, own);
}

}  // namespace

// The signal as shells tell it; 0 if the process ended by itself.
int ProcessEnd::signal() const {
  constexpr int kMostSignals = 64;  // mpirun has exit codes of its own beyond
  return exit_code > 128 && exit_code <= 128 + kMostSignals ? exit_code - 128 : 0;
}

std::string ProcessEnd::reason() const {
  if (exit_code == 127) return "mpirun is not installed (Debian package openmpi-bin)";
  if (exit_code == drivers::kInterrupted) return "it was stopped; the same command continues it";
  if (signal() == SIGKILL) return "it was killed; memory may have been too small";
  if (signal() > 0)
    return std::string("it crashed: ") + strsignal(signal()) +
           (last_line.empty() ? "" : "; its last message: " + last_line);
  const std::string prefix = "traceraft: ";
  if (last_line.rfind(prefix, 0) == 0) return last_line.substr(prefix.size());
  return last_line.empty() ? "exit code " + std::to_string(exit_code) : last_line;
}

bool ProcessEnd::was_stopped() const {
  return posix::stop_requested() || exit_code == drivers::kInterrupted || signal() == SIGTERM ||
         signal() == SIGINT;
}

bool ProcessEnd::concerns_input() const {
  switch (exit_code) {
    case drivers::kSuccess:
    case drivers::kBadInput:
    case drivers::kNumericalFailure:
    case drivers::kInternalError:
      return true;
    default:
      return signal() > 0 && signal() != SIGTERM && signal() != SIGINT;
  }
}

bool ProcessEnd::harms_no_other(const std::filesystem::path& folder) const {
  constexpr std::uintmax_t kLeastSpace = 64 << 20;  // bytes that a disk has that is not full
  return concerns_input() || (exit_code == drivers::kInputOutput &&
                              std::filesystem::space(folder).available >= kLeastSpace);
}

ProcessEnd run_program(const std::vector<std::string>& arguments, const std::filesystem::path& log,
                       int ranks, double time_limit) {
  std::vector<std::string> command = program_on(ranks);
  command.insert(command.end(), arguments.begin(), arguments.end());
  const std::uintmax_t before = std::filesystem::exists(log) ? std::filesystem::file_size(log) : 0;
  const posix::ChildResult result = posix::run_child({command, log, time_limit});
  std::string text = posix::read_file(log, kLargestLog);
  text.erase(0, std::min<std::size_t>(before, text.size()));
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return {result.exit_code, result.out_of_time, text.substr(text.rfind('\n') + 1)};
}

bench::RunProgram program_runner(std::filesystem::path scratch) {
  return [scratch = std::move(scratch)](const std::vector<std::string>& options, int ranks,
                                        int nodes) {
    remove_scratch(scratch);  // what a run that failed has left
    std::filesystem::create_directories(scratch);
    const std::filesystem::path folder = scratch / "run";
    std::vector<std::string> arguments = {"run",         "--scaled", "--out",     folder.string(),
                                          "--no-fields", "--quiet",  "--threads", "1"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProcessEnd end = run_program(arguments, scratch / "log", ranks);
    if (end.exit_code != drivers::kSuccess)
      throw std::runtime_error("a run on " + std::to_string(ranks) + " ranks: " + end.reason());
    const bench::ProgramRun run{run::summary_number(folder, "steps"),
                                run::summary_number(folder, "mass_drift"),
                                run::concentration_at_end(folder, nodes)};
    remove_scratch(scratch);
    return run;
  };
}

}  // namespace traceraft::jobs
