#include "drivers/explain/extended_model.hpp"

#include <algorithm>
#include <sstream>

#include "backends/posix/durable_file.hpp"
#include "drivers/config/config_file.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::explain {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxModelBytes = 1 << 20;

// Names whose values the file does not have.
std::vector<std::string> changed_names(const config::GivenValues& file,
                                       const config::GivenValues& wanted) {
  const config::Configuration before(file, {}), after(wanted, {});
  std::vector<std::string> names;
  for (const auto& [name, value] : wanted)
    if (config::config_lines(before, {name}) != config::config_lines(after, {name}))
      names.push_back(name);
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

bool is_that_model(const fs::path& file, const config::GivenValues& wanted) {
  try {
    return config::config_text({config::read_config_file(file), {}}) ==
           config::config_text({wanted, {}});
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

void write_extended_model(const fs::path& file, const fs::path& original,
                          const config::GivenValues& wanted, const std::string& heading) {
  const std::vector<std::string> names = changed_names(config::read_config_file(original), wanted);
  const config::Configuration whole(wanted, {});
  const std::string block = "# " + heading + "\n" + config::config_lines(whole, names);
  const std::string before = original.empty() ? "" : posix::read_file(original, kMaxModelBytes);
  posix::write_durably(file, with_block(before, names, block));
  // TOML has more ways to say things than one line each.
  if (!is_that_model(file, wanted)) posix::write_durably(file, config::config_text(whole));
}

}  // namespace traceraft::explain
