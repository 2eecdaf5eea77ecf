// The values of all options of one run, after defaults < case < file < flags.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "drivers/config/options.hpp"
#include "kernel/physics/units.hpp"

namespace traceraft {

// One source of values: option name -> text and the place it came from, for error messages.
struct GivenValue {
  std::string text;
  std::string where;  // "--cells" or "run.toml:3: cells"
};
using GivenValues = std::map<std::string, GivenValue>;

// The items between commas, without the blanks around them.
std::vector<std::string> split_list(const std::string& text);

class Configuration {
 public:
  // `file` and `flags` hold what the user gave. Every value is checked for kind and range; throws
  // InputError naming the value, where it stands and what is allowed.
  Configuration(const GivenValues& file, const GivenValues& flags);

  std::string text(const std::string& name) const;
  double number(const std::string& name) const;
  long long integer(const std::string& name) const;
  bool flag(const std::string& name) const;
  std::vector<double> numbers(const std::string& name) const;
  // Where a value was given, or "--name" for a default: starts every complaint about it.
  std::string where(const std::string& name) const;

  // Was it given by the user rather than by a case or a default?
  bool given(const std::string& name) const { return given_.count(name) != 0; }
  // And on the command line? A configuration file holds every option.
  bool from_flag(const std::string& name) const;

  Units units() const;
  long long noise_cells() const;  // with 0 resolved
  double noise_length() const;    // of its mesh, um

 private:
  void set(const OptionSpec& spec, const GivenValue& value);

  std::map<std::string, GivenValue> values_;
  std::set<std::string> given_;
};

}  // namespace traceraft
