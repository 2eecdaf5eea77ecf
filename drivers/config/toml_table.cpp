#include "drivers/config/toml_table.hpp"

// The library asserts that a key begins after "[" and reports just below what else it finds there,
// as in "[=". A debug build would abort on such a file instead of reporting its line.
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>

#include <algorithm>

#include "backends/posix/durable_file.hpp"
#include "drivers/config/toml_depth.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"

namespace traceraft::config {
namespace {

constexpr std::uint64_t kLargestConfiguration = 1 << 20;

std::string read_text(const std::filesystem::path& path, const std::string& context) {
  std::string text;
  try {
    text = posix::read_file(path, kLargestConfiguration);
  } catch (const IoError& error) {
    throw InputError(context + error.what());
  }
  const bool binary = std::any_of(text.begin(), text.end(), [](char ch) {
    const auto byte = static_cast<unsigned char>(ch);
    return byte < 32 && ch != '\n' && ch != '\r' && ch != '\t';
  });
  if (binary) throw InputError(context + path.string() + " is not a text file");
  return text;
}

// The parser's complaint, as in "Error while parsing key: expected ...", without its first part.
std::string without_stage(const std::string& complaint) {
  const std::string stage = "Error while parsing ";
  const std::size_t colon = complaint.find(": ");
  const bool has_stage = complaint.compare(0, stage.size(), stage) == 0;
  return (has_stage && colon != std::string::npos ? complaint.substr(colon + 2) : complaint)
      .substr(0, 200);
}

// The same number as a double, or a complaint.
double exactly(std::int64_t integer, const std::string& where) {
  constexpr std::int64_t kLargest = std::int64_t{1} << 53;
  if (integer <= kLargest && integer >= -kLargest) return static_cast<double>(integer);
  throw InputError(where + ": " + std::to_string(integer) +
                   " has too many digits (allowed: whole numbers up to " +
                   std::to_string(kLargest) + ")");
}

TomlValue value_of(const toml::node& node, const std::string& where) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (const auto flag = node.value_exact<bool>()) return *flag;
  if (const auto integer = node.value_exact<std::int64_t>()) return *integer;
  if (const auto number = node.value_exact<double>()) return *number;
  const toml::array* array = node.as_array();
  if (!array) return std::monostate();
  std::vector<double> numbers;
  for (const toml::node& item : *array) {
    if (!item.is_number()) return std::monostate();
    const auto integer = item.value_exact<std::int64_t>();
    numbers.push_back(integer ? exactly(*integer, where) : *item.value<double>());
  }
  return numbers;
}

}  // namespace

TomlTable TomlTable::read(const std::filesystem::path& path, const std::vector<std::string>& known,
                          const std::string& context) {
  const std::string text = read_text(path, context);
  if (const long line = line_of_deep_key(text); line > 0)
    throw InputError(path.string() + ":" + std::to_string(line) +
                     ": a key of many parts between dots; keys are single names here");
  toml::table parsed;
  try {
    parsed = toml::parse(text, path.string());
  } catch (const toml::parse_error& error) {
    throw InputError(path.string() + ":" + std::to_string(error.source().begin.line) + ": " +
                     "this is no TOML: " + without_stage(std::string(error.description())));
  }
  TomlTable table;
  table.path_ = path;
  for (const auto& [key, node] : parsed) {
    const std::string name(key.str());
    const long line = static_cast<long>(key.source().begin.line);
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(path.string() + ":" + std::to_string(line) + ": " +
                       unknown_name_message("key", name, known));
    table.entries_[name] = {std::monostate(), line};
    table.entries_[name].value = value_of(node, table.where(name));
  }
  return table;
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> result;
  for (const auto& entry : entries_) result.push_back(entry.first);
  return result;
}

std::string TomlTable::where(const std::string& key) const {
  return path_.string() + (has(key) ? ":" + std::to_string(entries_.at(key).line) : "") + ": " +
         key;
}

const TomlValue& TomlTable::needed(const std::string& key) const {
  if (!has(key)) throw InputError(where(key) + " is missing");
  return value(key);
}

std::string TomlTable::text(const std::string& key) const {
  if (const auto* text = std::get_if<std::string>(&needed(key))) return *text;
  throw InputError(where(key) + ": a text in quotes is needed here");
}

double TomlTable::number(const std::string& key) const {
  const TomlValue& found = needed(key);
  if (const auto* integer = std::get_if<std::int64_t>(&found)) return exactly(*integer, where(key));
  if (const auto* number = std::get_if<double>(&found)) return *number;
  throw InputError(where(key) + ": a number is needed here");
}

std::string TomlTable::text_or(const std::string& key, const std::string& otherwise) const {
  return has(key) ? text(key) : otherwise;
}

double TomlTable::number_or(const std::string& key, double otherwise) const {
  return has(key) ? number(key) : otherwise;
}

}  // namespace traceraft::config
