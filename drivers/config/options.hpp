// The one table of options: every entry is a flag of `run` and a key of a configuration file.
#pragma once

#include <string>
#include <vector>

namespace traceraft {

enum class OptionKind { text, path, number, integer, flag, numbers /* comma-separated */ };

// What an option measures: under --scaled, lengths are in R and times in R²/D.
enum class Dimension { none, length, time };

// Whole numbers up to it are exact in files that other programs read (2^53).
inline constexpr double kLargestSeed = 9007199254740992;

struct OptionSpec {
  std::string name;
  OptionKind kind;
  std::string default_text;  // in µm and s
  std::string group;
  std::string help;
  double min = 0, max = 0;  // of numbers, in µm and s; not checked if equal
  Dimension dimension = Dimension::none;
  bool numerical = true;  // does it change the numbers of a run?
  bool list = false;      // of what stands between semicolons; several flags are joined by them
};

struct IntegratorEntry;
struct LinearSolverEntry;
struct ParameterSpec;
struct WordOption;
// "ida-maxord": the name of an option that one integrator has.
std::string integrator_option(const IntegratorEntry& integrator, const ParameterSpec& parameter);
// "teko-inverse": the name of an option that one linear solver has.
std::string linear_solver_option(const LinearSolverEntry& solver, const WordOption& option);

const std::vector<OptionSpec>& run_options();
const OptionSpec& run_option(const std::string& name);  // throws InputError
std::vector<std::string> run_option_names();

}  // namespace traceraft
