// Options of a run as flags of the command line.
#pragma once

#include <CLI/CLI.hpp>

#include "drivers/config/configuration.hpp"

namespace traceraft {

// Adds every option that `wanted` accepts as a flag whose text goes to `values`, which has to live
// as long as the command.
template <class Wanted>
void add_options(CLI::App& command, GivenValues& values, const Wanted& wanted) {
  for (const OptionSpec& spec : run_options()) {
    if (!wanted(spec)) continue;
    const std::string flag = "--" + spec.name;
    const auto store = [&values, name = spec.name, flag](const std::string& text) {
      values[name] = {text, flag};
    };
    CLI::Option* option =
        spec.kind == OptionKind::flag
            ? command.add_flag_function(
                  "--" + spec.name + ",!--no-" + spec.name,
                  [store](std::int64_t count) { store(count > 0 ? "true" : "false"); }, spec.help)
            : command.add_option_function<std::string>(flag, store, spec.help);
    option->group(spec.group);
    if (spec.list) option->join(';');
    if (!spec.default_text.empty() && spec.kind != OptionKind::flag)
      option->default_str(spec.default_text)->run_callback_for_default(false);
  }
}

}  // namespace traceraft
