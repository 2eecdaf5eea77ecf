// The one table of options: every entry is a flag of `run` and a key of a configuration file.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace traceraft {
struct ParameterSpec;
}
namespace traceraft::config {

enum class OptionKind { text, path, number, integer, flag, numbers /* comma-separated */ };

// The dimension of an option: under --scaled, lengths are in R and times in R²/D.
enum class Dimension { none, length, time };

// Whole numbers up to it are exact in files that other programs read (2^53).
inline constexpr double kLargestSeed = 9007199254740992;

// The values of the options, under --scaled in units of R and R²/D as the user gave them.
struct RunOptions {
  std::string case_name;
  bool scaled = false;
  std::string model;  // field or discs

  std::string surface, surface_formula;
  double radius = 0;  // µm
  std::int64_t cells = 0;
  double cells_per_boundary = 0;
  std::string mesh;  // uniform or adaptive
  std::int64_t mesh_levels = 0;
  double mesh_threshold = 0;

  double epsilon = 0;    // µm or R
  double diffusion = 0;  // cm²/s
  std::string mobility, well, effect, potential;
  double stabilisation = 0, mass_stabilisation = 0;

  std::string initial, initial_formula, initial_caps;
  double raft_fraction = 0;
  std::int64_t noise_cells = 0, seed = 0;

  double t_end = 0;  // s or R²/D, as the other times
  std::vector<double> output_times;
  std::string integrator;
  double tolerance = 0, initial_step = 0, min_step = 0, max_step = 0;
  std::string keep, energy_guard;

  std::string linear_solver;
  double linear_tolerance = 0;
  std::int64_t threads = 0;

  double checkpoint_interval = 0;  // s
  bool fields = false;

  // Those that one integrator or linear solver has, by the names of their flags.
  std::map<std::string, double> method_numbers;
  std::map<std::string, std::string> method_words;
};

// Where the value of an option is; none of those of one method.
using OptionMember =
    std::variant<std::monostate, std::string RunOptions::*, double RunOptions::*,
                 std::int64_t RunOptions::*, bool RunOptions::*, std::vector<double> RunOptions::*>;

struct OptionSpec {
  std::string name;
  OptionMember member;
  std::string default_text;  // in µm and s
  std::string group;
  std::string help;
  double min = 0, max = 0;  // of numbers, in µm and s; not checked if equal
  Dimension dimension = Dimension::none;
  bool numerical = true;  // does it change the numbers of a run?
  bool list = false;      // of what stands between semicolons; several flags are joined by them
  OptionKind kind = OptionKind::text;  // of the member, where there is one
  std::string placeholder = {};  // of its value in the help: NUMBER, FILE, the name of a list, ...
  std::vector<std::string> words = {};  // the only texts it takes, if they are a few
};

// "ida-maxord": the name of an option that one integrator or linear solver has.
std::string method_option(const std::string& method, const ParameterSpec& parameter);

const std::vector<OptionSpec>& run_options();
const OptionSpec& run_option(const std::string& name);  // throws InputError
const OptionSpec& run_option(const OptionMember& member);
std::vector<std::string> run_option_names();

}  // namespace traceraft::config
