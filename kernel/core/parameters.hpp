// Named options of surfaces, mobility laws, initial states, effects, integrators and linear
// solvers. Numbers have units and ranges, and appear in "name:key=value,key=value" arguments, too.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace traceraft {

enum class ParameterKind { number, integer, word, file };

struct ParameterSpec {
  std::string name;
  std::string unit;  // "" for a pure number
  double default_value;
  double min;
  double max;  // closed range [min, max]
  std::string meaning;
  ParameterKind kind = ParameterKind::number;
  std::string default_text = {};  // of a word or the path of a file

  bool is_number() const { return kind == ParameterKind::number || kind == ParameterKind::integer; }
};

// Throws std::logic_error if it is not declared.
std::size_t place_of(std::string_view name, const std::vector<ParameterSpec>& specs);

// An option that is a word or the path of a file.
inline ParameterSpec text_parameter(std::string name, std::string default_text, std::string meaning,
                                    ParameterKind kind = ParameterKind::word) {
  return {std::move(name), "", 0, 0, 0, std::move(meaning), kind, std::move(default_text)};
}

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
