#include "drivers/config/config_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "backends/posix/durable_file.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft {
namespace {

constexpr std::uint64_t kMaxBytes = 1 << 20;

std::string read_text(const std::filesystem::path& path) {
  std::string text;
  try {
    text = read_file(path, kMaxBytes);
  } catch (const IoError& error) {
    throw InputError(std::string("--config: ") + error.what());
  }
  const bool binary = std::any_of(text.begin(), text.end(), [](char ch) {
    const auto byte = static_cast<unsigned char>(ch);
    return byte < 32 && ch != '\n' && ch != '\r' && ch != '\t';
  });
  if (binary) throw InputError("--config: " + path.string() + " is not a text file");
  return text;
}

std::string number_text(const toml::node& node, const std::string& where) {
  if (const auto integer = node.value_exact<std::int64_t>()) return std::to_string(*integer);
  if (const auto number = node.value_exact<double>()) return format_number(*number);
  throw InputError(where + ": a number is needed here");
}

std::string value_text(const OptionSpec& spec, const toml::node& node, const std::string& where) {
  switch (spec.kind) {
    case OptionKind::text:
    case OptionKind::path:
      if (const auto text = node.value_exact<std::string>()) return *text;
      throw InputError(where + ": a text in quotes is needed here");
    case OptionKind::flag:
      if (const auto flag = node.value_exact<bool>()) return *flag ? "true" : "false";
      throw InputError(where + ": true or false is needed here");
    case OptionKind::numbers: {
      const toml::array* array = node.as_array();
      if (!array) throw InputError(where + ": a list of numbers is needed here, as in [1, 10]");
      std::string text;
      for (const toml::node& item : *array)
        text += (text.empty() ? "" : ",") + number_text(item, where);
      return text;
    }
    default:
      return number_text(node, where);
  }
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char ch) { return static_cast<unsigned char>(ch) < 32; }, ' ');
  return text.substr(0, 200);
}

std::string number_list(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + format_number(number);
  return "[" + text + "]";
}

std::string toml_value(const OptionSpec& spec, const Configuration& configuration) {
  switch (spec.kind) {
    case OptionKind::text:
    case OptionKind::path:
      return nlohmann::json(configuration.text(spec.name)).dump();  // JSON strings are TOML strings
    case OptionKind::flag:
      return configuration.text(spec.name);
    case OptionKind::numbers:
      return number_list(configuration.numbers(spec.name));
    default:
      return format_number(configuration.number(spec.name));  // "5." and ".5" are no TOML
  }
}

}  // namespace

GivenValues read_config_file(const std::filesystem::path& path) {
  if (path.empty()) return {};
  const std::string text = read_text(path);
  toml::table table;
  try {
    table = toml::parse(text, path.string());
  } catch (const toml::parse_error& error) {
    throw InputError(path.string() + ":" + std::to_string(error.source().begin.line) + ": " +
                     one_line(std::string(error.description())));
  }
  GivenValues values;
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    const std::string place = path.string() + ":" + std::to_string(key.source().begin.line) + ": ";
    const std::vector<std::string> names = run_option_names();
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(place + unknown_name_message("key", name, names));
    const std::string where = place + name;
    values[name] = {value_text(run_option(name), node, where), where};
  }
  return values;
}

std::string config_text(const Configuration& configuration) {
  std::string text, group;
  for (const OptionSpec& spec : run_options()) {
    if (spec.group != group) text += "\n# " + spec.group + "\n";
    group = spec.group;
    text += spec.name + " = " + toml_value(spec, configuration) + "  # " + spec.help + "\n";
  }
  return text.substr(1);
}

std::string numerical_identity(const Configuration& configuration) {
  std::string identity;
  for (const OptionSpec& spec : run_options())
    if (spec.numerical) identity += spec.name + " = " + toml_value(spec, configuration) + "\n";
  return identity;
}

}  // namespace traceraft
