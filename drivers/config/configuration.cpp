#include "drivers/config/configuration.hpp"

#include <algorithm>
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

namespace traceraft::config {
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

// Did the user leave the mesh of the case as it is?
bool keeps_mesh(const CaseEntry& chosen, const GivenValues& file, const GivenValues& flags) {
  const auto given = [&](const char* name) { return find_given(file, flags, name); };
  if (given("cells") || given("cells-per-boundary")) return false;
  const GivenValue* mesh = given("mesh");
  return !mesh || std::count(chosen.mesh.begin(), chosen.mesh.end(),
                             std::pair(std::string("mesh"), mesh->text)) > 0;
}

// A run folder stays resumable from everywhere.
std::string with_absolute_path(const OptionSpec& spec, const GivenValue& value) {
  if (spec.kind == OptionKind::path && !value.text.empty())
    return std::filesystem::absolute(value.text).string();
  const NamedArguments parts = split_named_arguments(value.text);
  if (spec.member != OptionMember(&RunOptions::initial) || parts.name != "restart")
    return value.text;
  if (parts.arguments.empty())
    throw InputError(value.where +
                     ": restart needs the folder of a run, as in restart:runs/earlier");
  return "restart:" + std::filesystem::absolute(parts.arguments).string();
}

}  // namespace

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> items;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');) {
    const std::size_t begin = item.find_first_not_of(' '), end = item.find_last_not_of(' ');
    items.push_back(begin == std::string::npos ? "" : item.substr(begin, end - begin + 1));
  }
  if (!text.empty() && text.back() == ',') items.emplace_back();
  return items;
}

double cells_that_double(double least) {
  constexpr double kMultiple = 32;
  return kMultiple * std::ceil(least / kMultiple - 1e-9);
}

GivenValues uniform_mesh() {
  return {{"mesh", {"uniform", "mesh"}}};
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
  if (keeps_mesh(*chosen, file, flags))
    for (const auto& [name, text] : chosen->mesh) defaults[name] = text;
  for (const char* name : {"scaled", "radius", "diffusion"}) {
    const GivenValue* value = find_given(file, flags, name);
    set(run_option(name), value ? *value : GivenValue{defaults[name], std::string("--") + name});
  }
  const physics::Units scaled_units = units();
  physics::Units physical = scaled_units;
  physical.scaled = false;
  for (const OptionSpec& spec : run_options()) {
    for (const GivenValues* values : {&file, &flags})  // a flag is taken, and the file checked
      if (const auto value = values->find(spec.name); value != values->end()) {
        set(spec, value->second);
        given_.insert(spec.name);
      }
    if (given_.count(spec.name) > 0) continue;
    std::string text = defaults[spec.name];
    if (scaled_units.scaled && spec.dimension != Dimension::none && !text.empty()) {
      const double unit = spec.dimension == Dimension::length ? physical.length() : physical.time();
      text = format_number(parse_number(spec.name, text) / unit);
    }
    set(spec, {text, "--" + spec.name});
  }
  if (!given(&RunOptions::tolerance) && options_.model == "discs")
    set_text(run_option(&RunOptions::tolerance), "5e-3");
  else if (!given(&RunOptions::tolerance))
    for (const backends::IntegratorEntry& integrator : backends::integrators())
      if (integrator.name == options_.integrator)
        set_text(run_option(&RunOptions::tolerance), format_number(integrator.tolerance));
  if (options_.model == "discs" && options_.initial == "noise" && !given(&RunOptions::initial))
    set_text(run_option(&RunOptions::initial), "discs");
  if (options_.cells_per_boundary > 0) set_cells_by_boundary();
  // A case's choice is for its own mesh.
  if (!given(&RunOptions::noise_cells) && options_.noise_cells > options_.cells)
    set_text(run_option(&RunOptions::noise_cells), std::to_string(options_.cells));
}

void Configuration::set_cells_by_boundary() {
  constexpr double kWidths = 6;  // of a boundary, in epsilon
  if (given(&RunOptions::cells))
    throw InputError(where(&RunOptions::cells_per_boundary) +
                     ": give either this or the number of cells");
  const double epsilon = options_.epsilon / units().length();
  const double wanted = 2 * mesh::kBoxHalfWidth * options_.cells_per_boundary / (kWidths * epsilon);
  const OptionSpec& cells = run_option(&RunOptions::cells);
  const double number = cells_that_double(wanted);
  if (!(number <= cells.max))
    throw InputError(where(&RunOptions::cells_per_boundary) + ": it needs " +
                     format_number(std::ceil(wanted)) + " cells per edge, more than " +
                     format_number(cells.max));
  set_text(cells, std::to_string(static_cast<std::int64_t>(number)));
  set_text(run_option(&RunOptions::cells_per_boundary), "0");  // files hold the cells
}

bool Configuration::from_flag(const std::string& name) const {
  return given(name) && where(name).compare(0, 2, "--") == 0;
}

std::int64_t Configuration::noise_cells() const {
  return options_.noise_cells > 0 ? options_.noise_cells
                                  : std::max(std::int64_t{1}, options_.cells / 4);
}

double Configuration::noise_length() const {
  return mesh::CubeMesh{noise_cells()}.h() * units().length();
}

void Configuration::set(const OptionSpec& spec, const GivenValue& value) {
  double unit = 1;
  if (spec.dimension != Dimension::none && options_.scaled) {
    physics::Units physical = units();
    physical.scaled = false;
    unit = spec.dimension == Dimension::length ? physical.length() : physical.time();
  }
  switch (spec.kind) {
    case OptionKind::text:
    case OptionKind::path:
      for (const char ch : value.text)
        if (static_cast<unsigned char>(ch) < 32 || ch == 127)
          throw InputError(value.where + ": the text contains a control character");
      if (!text::is_utf8(value.text)) throw InputError(value.where + ": the text is not UTF-8");
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
        if (item.empty())
          throw InputError(value.where + ": a number is missing between two commas, or at an end");
        if (item.find_first_of(" ;\t") != std::string::npos)
          throw InputError(value.where + ": '" + item.substr(0, 60) +
                           "' is not a number; separate numbers by commas");
        checked_number(spec, value, item, unit);
      }
      break;
  }
  values_[spec.name] = value;
  set_text(spec, with_absolute_path(spec, value));
}

void Configuration::set_text(const OptionSpec& spec, const std::string& text) {
  values_[spec.name].text = text;
  if (const auto* member = std::get_if<std::string RunOptions::*>(&spec.member)) {
    options_.** member = text;
  } else if (const auto* number = std::get_if<double RunOptions::*>(&spec.member)) {
    options_.** number = parse_number(spec.name, text);
  } else if (const auto* integer = std::get_if<std::int64_t RunOptions::*>(&spec.member)) {
    options_.** integer = static_cast<std::int64_t>(parse_number(spec.name, text));
  } else if (const auto* flag = std::get_if<bool RunOptions::*>(&spec.member)) {
    options_.** flag = text == "true";
  } else if (const auto* list = std::get_if<std::vector<double> RunOptions::*>(&spec.member)) {
    options_.** list = numbers(spec);
  } else if (spec.kind == OptionKind::number || spec.kind == OptionKind::integer) {
    options_.method_numbers[spec.name] = parse_number(spec.name, text);
  } else {
    options_.method_words[spec.name] = text;
  }
}

std::vector<double> Configuration::numbers(const OptionSpec& spec) const {
  std::vector<double> result;
  for (const std::string& item : split_list(text(spec.name)))
    result.push_back(parse_number(spec.name, item));
  return result;
}

physics::Units Configuration::units() const {
  return {options_.radius, options_.diffusion, options_.scaled};
}

}  // namespace traceraft::config
