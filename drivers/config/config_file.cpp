#include "drivers/config/config_file.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "drivers/config/option_needs.hpp"
#include "drivers/config/toml_table.hpp"
#include "drivers/text/encoders.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft::config {
namespace {

std::string number_text(const TomlTable& table, const std::string& key, const std::string& where) {
  if (const auto* integer = std::get_if<std::int64_t>(&table.value(key)))
    return std::to_string(*integer);
  if (const auto* number = std::get_if<double>(&table.value(key))) return format_number(*number);
  throw InputError(where + ": a number is needed here");
}

std::string value_text(const OptionSpec& spec, const TomlTable& table, const std::string& where) {
  const TomlValue& value = table.value(spec.name);
  if (const auto* number = std::get_if<double>(&value);
      number && spec.kind == OptionKind::integer && *number >= kLargestSeed)
    throw InputError(where + ": whole numbers as large as this are written in digits alone");
  switch (spec.kind) {
    case OptionKind::text:
    case OptionKind::path:
      return table.text(spec.name);
    case OptionKind::flag:
      if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
      throw InputError(where + ": true or false is needed here");
    case OptionKind::numbers: {
      const auto* numbers = std::get_if<std::vector<double>>(&value);
      if (!numbers) throw InputError(where + ": a list of numbers is needed here, as in [1, 10]");
      std::string text;
      for (const double number : *numbers)
        text += (text.empty() ? "" : ",") + format_number(number);
      return text;
    }
    default:
      return number_text(table, spec.name, where);
  }
}

// "5." and ".5" are no TOML.
std::string number_list(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + format_number(number);
  return text;
}

std::string toml_value(const OptionSpec& spec, const Configuration& configuration) {
  switch (spec.kind) {
    case OptionKind::text:
    case OptionKind::path:
      return nlohmann::json(configuration.text(spec.name)).dump();  // JSON strings are TOML strings
    case OptionKind::flag:
      return configuration.text(spec.name);
    case OptionKind::numbers:
      return "[" + number_list(configuration.numbers(spec)) + "]";
    default:
      return number_list(configuration.numbers(spec));
  }
}

std::string config_line(const OptionSpec& spec, const Configuration& configuration) {
  return spec.name + " = " + toml_value(spec, configuration) + "  # " + spec.help + "\n";
}

}  // namespace

GivenValues read_config_file(const std::filesystem::path& path, const std::string& flag) {
  if (path.empty()) return {};
  const TomlTable table = TomlTable::read(path, run_option_names(), flag + ": ");
  GivenValues values;
  for (const std::string& name : table.keys())
    values[name] = {value_text(run_option(name), table, table.where(name)), table.where(name)};
  return values;
}

bool is_model_word(const std::string& file_or_word) {
  const std::vector<std::string>& words = run_option(&RunOptions::model).words;
  return std::find(words.begin(), words.end(), file_or_word) != words.end();
}

GivenValues read_model(const std::string& file_or_word) {
  if (!is_model_word(file_or_word)) return read_config_file(file_or_word, "--model");
  return {{"model", {file_or_word, "--model"}}};
}

std::string config_text(const Configuration& configuration) {
  std::string text, group;
  for (const OptionSpec& spec : run_options()) {
    if (spec.group != group) text += "\n# " + spec.group + "\n";
    group = spec.group;
    text += config_line(spec, configuration);
  }
  return text.substr(1);
}

std::string config_lines(const Configuration& configuration,
                         const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += config_line(run_option(name), configuration);
  return text;
}

std::string flags_text(const Configuration& configuration) {
  // The options that other defaults depend on: first those that the units depend on, then all.
  GivenValues first;
  for (const char* name : {"case", "scaled", "integrator"})
    first[name] = {configuration.text(name), ""};
  GivenValues deciding = first;
  for (const char* name : {"radius", "diffusion"}) deciding[name] = {configuration.text(name), ""};
  const Configuration nothing({}, {}), of_case({}, first);
  // The one of these by which the user left the mesh of the case.
  for (const char* name : {"cells", "mesh"})
    if (configuration.text(name) != of_case.text(name)) {
      deciding[name] = {configuration.text(name), ""};
      break;
    }
  const Configuration usual({}, deciding);
  std::string text;
  for (const OptionSpec& spec : run_options()) {
    const Configuration& defaults = first.count(spec.name) > 0      ? nothing
                                    : deciding.count(spec.name) > 0 ? of_case
                                                                    : usual;
    const std::string value = toml_value(spec, configuration);
    if (!spec.numerical || value == toml_value(spec, defaults) || is_idle(configuration, spec.name))
      continue;
    text += text.empty() ? "--" : " --";
    if (spec.kind == OptionKind::flag)
      text += (configuration.text(spec.name) == "true" ? "" : "no-") + spec.name;
    else
      text += spec.name + " " + text::in_shell(configuration.text(spec.name));
  }
  return text;
}

std::string numerical_identity(const Configuration& configuration) {
  std::string identity;
  for (const OptionSpec& spec : run_options())
    if (spec.numerical) identity += spec.name + " = " + toml_value(spec, configuration) + "\n";
  return identity;
}

std::vector<std::string> differing_options(const Configuration& a, const Configuration& b) {
  std::vector<std::string> names;
  for (const OptionSpec& spec : run_options())
    if (spec.numerical && toml_value(spec, a) != toml_value(spec, b)) names.push_back(spec.name);
  return names;
}

}  // namespace traceraft::config
