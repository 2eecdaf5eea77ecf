#include "drivers/manual/completions.hpp"
#include "drivers/manual/shell_tables.hpp"
#include "drivers/manual/value_lists.hpp"
#include "drivers/text/encoders.hpp"

namespace traceraft::manual {
namespace {

// The argument of --arguments, which fish reads a second time: words, each with a tab and its
// meaning.
std::string fish_arguments(const OfferedValues& offered) {
  std::string list;
  for (const auto& [name, meaning] : offered.values)
    list += (list.empty() ? "" : " ") + text::in_fish(name) +
            (meaning.empty() ? "" : "\\t" + text::in_fish(meaning));
  return text::in_fish(offered.several ? "(__fish_append , " + list + ")" : list);
}

// The part of a line of fish that offers values of an option.
std::string fish_offer(const std::string& placeholder) {
  const OfferedValues offered = offered_values(placeholder);
  switch (offered.kind) {
    case OfferedValues::Kind::names:
      return " --no-files --arguments " + fish_arguments(offered);
    case OfferedValues::Kind::files:
      return " --force-files";
    case OfferedValues::Kind::folders:
      return " --no-files --arguments '(__fish_complete_directories)'";
    default:
      return " --no-files";
  }
}

std::string fish_lines(const std::string& condition, const DescribedOption& option) {
  const std::string begin = "complete --command traceraft --condition " + text::in_fish(condition);
  if (option.flags.empty()) return begin + fish_offer(option.placeholder) + "\n";
  std::string lines;
  for (const std::string& flag : long_flags({option}))
    lines += begin + " --long-option " + text::in_fish(flag.substr(2)) +
             (option.takes_value() ? " --require-parameter" + fish_offer(option.placeholder) : "") +
             " --description " + text::in_fish(option.help) + "\n";
  return lines;
}

std::string fish_completions(const DescribedProgram& program) {
  const std::string first = "__fish_use_subcommand";
  std::string script =
      "# Completes the command line of traceraft in fish: traceraft completions fish\n\n"
      "complete --command traceraft --no-files\n";
  for (const DescribedOption& option : program.options) script += fish_lines(first, option);
  for (const DescribedCommand& command : program.commands)
    script += "complete --command traceraft --condition " + text::in_fish(first) + " --arguments " +
              text::in_fish(text::in_fish(command.name)) + " --description " +
              text::in_fish(command.summary) + "\n";
  for (const DescribedCommand& command : program.commands) {
    script += "\n";
    const std::string condition = "__fish_seen_subcommand_from " + text::in_fish(command.name);
    for (const DescribedOption& positional : command.positionals)
      script += fish_lines(condition, positional);
    for (const DescribedOption& option : command.options) script += fish_lines(condition, option);
  }
  return script;
}

}  // namespace

ShellEntry fish_shell() {
  return {"fish", fish_completions};
}

}  // namespace traceraft::manual
