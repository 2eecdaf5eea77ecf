#include "drivers/explain/extended_model.hpp"

#include <algorithm>
#include <sstream>

#include "backends/posix/durable_file.hpp"
#include "drivers/config/config_file.hpp"
#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxModelBytes = 1 << 20;

// Names whose values the file does not have.
std::vector<std::string> changed_names(const GivenValues& file, const GivenValues& wanted) {
  const Configuration before(file, {}), after(wanted, {});
  std::vector<std::string> names;
  for (const auto& [name, value] : wanted)
    if (config_lines(before, {name}) != config_lines(after, {name})) names.push_back(name);
  return names;
}

// "diffusion" of "diffusion = 2e-5  # cm^2/s"; keys of model files stand in tables of no name.
std::string key_of(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t"), equals = line.find('=');
  if (first == std::string::npos || equals == std::string::npos) return "";
  const std::string key = line.substr(first, equals - first);
  return key.substr(0, key.find_last_not_of(" \t") + 1);
}

// The block takes the place of the first line that it replaces.
std::string with_block(const std::string& original, const std::vector<std::string>& names,
                       const std::string& block) {
  std::istringstream lines(original);
  std::string line, text;
  bool placed = false;
  while (std::getline(lines, line)) {
    const bool replaced = std::count(names.begin(), names.end(), key_of(line)) > 0;
    if (replaced && !placed) text += block;
    placed = placed || replaced;
    if (!replaced) text += line + "\n";
  }
  return placed ? text : text + block;
}

bool is_that_model(const fs::path& file, const GivenValues& wanted) {
  try {
    return config_text({read_config_file(file), {}}) == config_text({wanted, {}});
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

void write_extended_model(const fs::path& file, const fs::path& original, const GivenValues& wanted,
                          const std::string& heading) {
  const std::vector<std::string> names = changed_names(read_config_file(original), wanted);
  const Configuration whole(wanted, {});
  const std::string block = "# " + heading + "\n" + config_lines(whole, names);
  const std::string before = original.empty() ? "" : read_file(original, kMaxModelBytes);
  write_durably(file, with_block(before, names, block));
  // TOML has more ways to say things than one line each.
  if (!is_that_model(file, wanted)) write_durably(file, config_text(whole));
}

}  // namespace traceraft
