#include "kernel/core/parameters.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"

namespace traceraft {

std::size_t place_of(std::string_view name, const std::vector<ParameterSpec>& specs) {
  const auto found = std::find_if(specs.begin(), specs.end(),
                                  [&](const ParameterSpec& spec) { return spec.name == name; });
  if (found == specs.end())
    throw std::logic_error("parameter '" + std::string(name) + "' was not declared");
  return static_cast<std::size_t>(found - specs.begin());
}

Parameters::Parameters(const std::vector<ParameterSpec>& specs, std::vector<double> values)
    : values_(std::move(values)) {
  for (const ParameterSpec& spec : specs) names_.push_back(spec.name);
}

double Parameters::operator[](std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end())
    throw std::logic_error("parameter '" + std::string(name) + "' was not declared");
  return values_[static_cast<std::size_t>(found - names_.begin())];
}

NamedArguments split_named_arguments(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return {std::string(text), ""};
  return {std::string(text.substr(0, colon)), std::string(text.substr(colon + 1))};
}

std::string format_number(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

double parse_number(std::string_view context, std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const char* begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
  const auto result = std::from_chars(begin, end, value);
  if (text.empty() || result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
    throw InputError(std::string(context) + ": '" + std::string(text.substr(0, 60)) +
                     "' is not a finite number");
  return value;
}

Parameters parse_parameters(std::string_view context, std::string_view arguments,
                            const std::vector<ParameterSpec>& specs) {
  std::vector<std::string> names;
  std::vector<double> values;
  for (const ParameterSpec& spec : specs) {
    names.push_back(spec.name);
    values.push_back(spec.default_value);
  }
  std::vector<bool> given(specs.size(), false);
  while (!arguments.empty()) {
    const std::size_t comma = arguments.find(',');
    const std::string_view item = arguments.substr(0, comma);
    arguments = comma == std::string_view::npos ? "" : arguments.substr(comma + 1);
    const std::size_t equals = item.find('=');
    const std::string key(item.substr(0, equals));
    const auto found = std::find(names.begin(), names.end(), key);
    const std::string where(context);
    if (found == names.end())
      throw InputError(where + ": " + unknown_name_message("parameter", key, names));
    const auto i = static_cast<std::size_t>(found - names.begin());
    if (equals == std::string_view::npos)
      throw InputError(where + ": parameter '" + key + "' needs a value, as in " + key + "=" +
                       format_number(specs[i].default_value));
    if (given[i]) throw InputError(where + ": parameter '" + key + "' is given twice");
    given[i] = true;
    values[i] = parse_number(where + ": " + key, item.substr(equals + 1));
    if (!(values[i] >= specs[i].min && values[i] <= specs[i].max))
      throw InputError(where + ": " + key + "=" + format_number(values[i]) +
                       " is out of range (allowed: " + format_number(specs[i].min) + " to " +
                       format_number(specs[i].max) + ")");
    if (specs[i].kind == ParameterKind::integer && values[i] != std::floor(values[i]))
      throw InputError(where + ": " + key + "=" + format_number(values[i]) +
                       " is not a whole number");
  }
  return Parameters(specs, values);
}

}  // namespace traceraft
