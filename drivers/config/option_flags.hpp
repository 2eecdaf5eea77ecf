// Options of a run as flags of the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>

#include "drivers/config/configuration.hpp"

namespace traceraft::config {

// Between the lists of a flag that is given more than once; no argument contains it.
inline constexpr char kBetweenFlags = '\n';

// Adds every option that `wanted` accepts as a flag whose text goes to `values`, which has to live
// as long as the command. The help shows what a run has without flags: the values of the default
// case, unless `others` says otherwise.
template <class Wanted>
void add_options(CLI::App& command, GivenValues& values, const Wanted& wanted,
                 const GivenValues& others = {}) {
  const Configuration defaults(others, {});
  for (const OptionSpec& spec : run_options()) {
    if (!wanted(spec)) continue;
    const std::string flag = "--" + spec.name;
    const auto store = [&values, name = spec.name, flag](std::string text) {
      std::replace(text.begin(), text.end(), kBetweenFlags, ',');
      values[name] = {std::move(text), flag};
    };
    CLI::Option* option =
        spec.kind == OptionKind::flag
            ? command.add_flag_function(
                  "--" + spec.name + ",!--no-" + spec.name,
                  [store](std::int64_t count) { store(count > 0 ? "true" : "false"); }, spec.help)
            : command.add_option_function<std::string>(flag, store, spec.help);
    option->group(spec.group);
    if (!spec.placeholder.empty()) option->type_name(spec.placeholder);
    if (spec.list) option->join(';');
    // Joined by commas, CLI11 would split lists at commas as well, and drop empty items.
    if (spec.kind == OptionKind::numbers) option->join(kBetweenFlags);
    if (const std::string text = defaults.text(spec.name);
        !text.empty() && spec.kind != OptionKind::flag)
      option->default_str(text)->run_callback_for_default(false);
  }
}

}  // namespace traceraft::config
