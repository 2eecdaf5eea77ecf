// Named numbers with units and ranges, as they appear in "name:key=value,key=value" arguments
// (surfaces, mobility laws, initial data, effects).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace traceraft {

struct ParameterSpec {
  std::string name;
  std::string unit;  // "" for a pure number
  double default_value;
  double min;
  double max;  // closed range [min, max]
  std::string meaning;
  bool integer = false;
};

// Values for a list of specs, in the order of the specs.
class Parameters {
 public:
  Parameters(const std::vector<ParameterSpec>& specs, std::vector<double> values);
  double operator[](std::string_view name) const;  // throws std::logic_error if not declared

 private:
  std::vector<std::string> names_;
  std::vector<double> values_;
};

// "torus:major=1,minor=0.4" -> name "torus", arguments "major=1,minor=0.4".
struct NamedArguments {
  std::string name;
  std::string arguments;
};
NamedArguments split_named_arguments(std::string_view text);

// Reads "key=value,key=value". Throws InputError naming `context` and the key for an unknown or
// repeated key, a value that is no finite number, or one outside its range.
Parameters parse_parameters(std::string_view context, std::string_view arguments,
                            const std::vector<ParameterSpec>& specs);

// The whole of `text` as a finite number. Throws InputError that starts with `context`.
double parse_number(std::string_view context, std::string_view text);

// The shortest text that reads back as the same number.
std::string format_number(double value);

}  // namespace traceraft
