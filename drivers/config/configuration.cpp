#include "drivers/config/configuration.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <sstream>

#include "backends/list.hpp"
#include "drivers/config/cases.hpp"
#include "drivers/text/utf8.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/mesh/cube_mesh.hpp"

namespace traceraft {
namespace {

bool parse_flag(const GivenValue& value) {
  if (value.text == "true") return true;
  if (value.text == "false") return false;
  throw InputError(value.where + ": '" + value.text + "' is neither true nor false");
}

// From 2^53 on a double may hold another whole number than the text does.
bool has_lost_digits(const std::string& text, double number) {
  if (!(std::fabs(number) >= kLargestSeed)) return false;
  std::int64_t exact = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data() + (text[0] == '+' ? 1 : 0), end, exact);
  return result.ec != std::errc() || result.ptr != end ||
         static_cast<long double>(exact) != static_cast<long double>(number);
}

double checked_number(const OptionSpec& spec, const GivenValue& value, const std::string& text,
                      double unit) {
  const double number = parse_number(value.where, text);
  const bool whole = spec.kind == OptionKind::integer;
  if (whole && number != std::floor(number))
    throw InputError(value.where + ": '" + text + "' is not a whole number");
  const bool lost = whole && has_lost_digits(text, number);
  if (spec.min < spec.max && (lost || !(number >= spec.min / unit && number <= spec.max / unit)))
    throw InputError(value.where + ": " + text +
                     " is out of range (allowed: " + format_number(spec.min / unit) + " to " +
                     format_number(spec.max / unit) + ")");
  return number;
}

const GivenValue* find_given(const GivenValues& file, const GivenValues& flags,
                             const std::string& name) {
  if (const auto found = flags.find(name); found != flags.end()) return &found->second;
  if (const auto found = file.find(name); found != file.end()) return &found->second;
  return nullptr;
}

}  // namespace

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> items;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');) {
    const std::size_t begin = item.find_first_not_of(' '), end = item.find_last_not_of(' ');
    items.push_back(begin == std::string::npos ? "" : item.substr(begin, end - begin + 1));
  }
  return items;
}

Configuration::Configuration(const GivenValues& file, const GivenValues& flags) {
  const auto user_value = [&](const char* name) {
    const GivenValue* value = find_given(file, flags, name);
    return value ? *value : GivenValue{run_option(name).default_text, std::string("--") + name};
  };
  const GivenValue case_value = user_value("case");
  const CaseEntry* chosen = nullptr;
  try {
    chosen = &cases().find(case_value.text);
  } catch (const InputError& error) {
    throw InputError(case_value.where + ": " + error.what());
  }
  // Units first: under --scaled, defaults given in µm and s are converted.
  std::map<std::string, std::string> defaults;
  for (const OptionSpec& spec : run_options()) defaults[spec.name] = spec.default_text;
  for (const auto& [name, text] : chosen->values) defaults[name] = text;
  for (const char* name : {"scaled", "radius", "diffusion"}) {
    const GivenValue* value = find_given(file, flags, name);
    set(run_option(name), value ? *value : GivenValue{defaults[name], std::string("--") + name});
  }
  const Units scaled_units = units();
  Units physical = scaled_units;
  physical.scaled = false;
  for (const OptionSpec& spec : run_options()) {
    if (const GivenValue* value = find_given(file, flags, spec.name)) {
      set(spec, *value);
      given_.insert(spec.name);
      continue;
    }
    std::string text = defaults[spec.name];
    if (scaled_units.scaled && spec.dimension != Dimension::none && !text.empty()) {
      const double unit = spec.dimension == Dimension::length ? physical.length() : physical.time();
      text = format_number(parse_number(spec.name, text) / unit);
    }
    set(spec, {text, "--" + spec.name});
  }
  if (!given("tolerance"))
    for (const IntegratorEntry& integrator : integrators())
      if (integrator.name == text("integrator"))
        values_["tolerance"].text = format_number(integrator.tolerance);
  // A case's choice is for its own mesh.
  if (!given("noise-cells") && integer("noise-cells") > integer("cells"))
    values_["noise-cells"].text = text("cells");
}

bool Configuration::from_flag(const std::string& name) const {
  return given(name) && where(name).compare(0, 2, "--") == 0;
}

long long Configuration::noise_cells() const {
  const long long own = integer("noise-cells");
  return own > 0 ? own : std::max(1LL, integer("cells") / 4);
}

double Configuration::noise_length() const {
  return CubeMesh{noise_cells()}.h() * units().length();
}

void Configuration::set(const OptionSpec& spec, const GivenValue& value) {
  double unit = 1;
  if (spec.dimension != Dimension::none && flag("scaled")) {
    Units physical = units();
    physical.scaled = false;
    unit = spec.dimension == Dimension::length ? physical.length() : physical.time();
  }
  switch (spec.kind) {
    case OptionKind::text:
    case OptionKind::path:
      for (const char ch : value.text)
        if (static_cast<unsigned char>(ch) < 32 || ch == 127)
          throw InputError(value.where + ": the text contains a control character");
      if (!is_utf8(value.text)) throw InputError(value.where + ": the text is not UTF-8");
      break;
    case OptionKind::flag:
      parse_flag(value);
      break;
    case OptionKind::number:
    case OptionKind::integer:
      checked_number(spec, value, value.text, unit);
      break;
    case OptionKind::numbers:
      for (const std::string& item : split_list(value.text)) {
        if (item.find_first_of(" ;\t") != std::string::npos)
          throw InputError(value.where + ": '" + item.substr(0, 60) +
                           "' is no number; commas stand between numbers");
        checked_number(spec, value, item, unit);
      }
      break;
  }
  values_[spec.name] = value;
  // A run folder stays resumable from everywhere.
  if (spec.kind == OptionKind::path && !value.text.empty())
    values_[spec.name].text = std::filesystem::absolute(value.text).string();
  if (const NamedArguments parts = split_named_arguments(value.text);
      spec.name == "initial" && parts.name == "restart") {
    if (parts.arguments.empty())
      throw InputError(value.where +
                       ": restart needs the folder of a run, as in restart:runs/earlier");
    values_[spec.name].text = "restart:" + std::filesystem::absolute(parts.arguments).string();
  }
}

std::string Configuration::text(const std::string& name) const {
  return values_.at(name).text;
}

std::string Configuration::where(const std::string& name) const {
  return values_.at(name).where;
}

double Configuration::number(const std::string& name) const {
  return parse_number(name, text(name));
}

long long Configuration::integer(const std::string& name) const {
  return static_cast<long long>(number(name));
}

bool Configuration::flag(const std::string& name) const {
  return text(name) == "true";
}

std::vector<double> Configuration::numbers(const std::string& name) const {
  std::vector<double> values;
  for (const std::string& item : split_list(text(name))) values.push_back(parse_number(name, item));
  return values;
}

Units Configuration::units() const {
  return {number("radius"), number("diffusion"), flag("scaled")};
}

}  // namespace traceraft
