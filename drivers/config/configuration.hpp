// The values of all options of one run, after defaults < case < file < flags.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "drivers/config/options.hpp"
#include "kernel/physics/units.hpp"

namespace traceraft::config {

// One source of values: option name -> text and the place it came from, for error messages.
struct GivenValue {
  std::string text;
  std::string where;  // "--cells" or "run.toml:3: cells"
};
using GivenValues = std::map<std::string, GivenValue>;

// Commands whose meshes are uniform add this to what the user gives: a case with another mesh then
// gives way.
GivenValues uniform_mesh();

// The least number of cells from `least` on that can double five times: a multiple of 32.
double cells_that_double(double least);

// The items between commas, without the blanks around them.
std::vector<std::string> split_list(const std::string& text);

class Configuration {
 public:
  // `file` and `flags` hold what the user gave. Every value is checked for kind and range; throws
  // InputError naming the value, where it stands and what is allowed.
  Configuration(const GivenValues& file, const GivenValues& flags);

  const RunOptions& options() const { return options_; }

  // The value as the user, the case or the default has it.
  const std::string& text(const std::string& name) const { return values_.at(name).text; }
  // The values of an option of kind number, integer or numbers.
  std::vector<double> numbers(const OptionSpec& spec) const;
  // Where a value was given, or "--name" for a default: starts every complaint about it.
  const std::string& where(const std::string& name) const { return values_.at(name).where; }
  const std::string& where(const OptionMember& m) const { return where(run_option(m).name); }

  // Was it given by the user rather than by a case or a default?
  bool given(const std::string& name) const { return given_.count(name) != 0; }
  bool given(const OptionMember& m) const { return given(run_option(m).name); }
  // And on the command line? A configuration file holds every option.
  bool from_flag(const std::string& name) const;
  bool from_flag(const OptionMember& m) const { return from_flag(run_option(m).name); }

  physics::Units units() const;
  std::int64_t noise_cells() const;  // with 0 resolved
  double noise_length() const;       // of its mesh, um; under --scaled R

 private:
  void set(const OptionSpec& spec, const GivenValue& value);
  void set_cells_by_boundary();
  void set_text(const OptionSpec& spec, const std::string& text);

  RunOptions options_;
  std::map<std::string, GivenValue> values_;
  std::set<std::string> given_;
};

}  // namespace traceraft::config
