#include "drivers/manual/shell_tables.hpp"

#include <algorithm>

#include "drivers/manual/value_lists.hpp"
#include "drivers/text/encoders.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::manual {
namespace {

// Options and arguments of all commands whose values may be the same.
struct ValueGroup {
  std::string placeholder;
  // Patterns of a shell's `case`: 'run --case', 'data argument 1', 'verify argument '*.
  std::vector<std::string> patterns;
};

void add_pattern(std::vector<ValueGroup>& groups, const std::string& placeholder,
                 const std::string& pattern) {
  auto group = std::find_if(groups.begin(), groups.end(), [&](const ValueGroup& each) {
    return each.placeholder == placeholder;
  });
  if (group == groups.end()) group = groups.insert(groups.end(), {placeholder, {}});
  group->patterns.push_back(pattern);
}

const char* kind_word(OfferedValues::Kind kind) {
  switch (kind) {
    case OfferedValues::Kind::names:
      return "names";
    case OfferedValues::Kind::files:
      return "files";
    case OfferedValues::Kind::folders:
      return "folders";
    default:
      return "anything";
  }
}

std::string set_names(const std::string& elements) {
  return "            kind=names several='' names=(" + elements + ")\n";
}

Meanings meanings_of(const std::vector<DescribedOption>& options) {
  Meanings flags;
  for (const DescribedOption& option : options)
    for (const std::string& flag : long_flags({option})) flags.emplace_back(flag, option.help);
  return flags;
}

// In the order in which the program has them.
std::vector<ValueGroup> value_groups(const DescribedProgram& program) {
  std::vector<ValueGroup> groups;
  for (const DescribedCommand& command : program.commands) {
    for (std::size_t k = 0; k < command.positionals.size(); ++k) {
      const DescribedOption& positional = command.positionals[k];
      const std::string argument = command.name + " argument ";
      add_pattern(groups, positional.placeholder,
                  positional.repeated ? text::in_shell(argument) + "*"
                                      : text::in_shell(argument + std::to_string(k + 1)));
    }
    for (const DescribedOption& option : command.options)
      if (option.takes_value())
        for (const std::string& flag : long_flags({option}))
          add_pattern(groups, option.placeholder, text::in_shell(command.name + " " + flag));
  }
  return groups;
}

std::string value_function(const DescribedProgram& program, const ArrayWriter& array) {
  std::string script =
      "_traceraft_value() {\n"
      "    kind=names several='' names=()\n"
      "    case \"$1 $2\" in\n";
  for (const ValueGroup& group : value_groups(program)) {
    const OfferedValues offered = offered_values(group.placeholder);
    script += "        " + joined(group.patterns, " | \\\n        ") + ")\n" +
              "            kind=" + kind_word(offered.kind) + (offered.several ? " several=," : "");
    if (!offered.values.empty()) script += " names=(" + array(offered.values) + ")";
    script += " ;;\n";
  }
  return script +
         "        *) return 1 ;;\n"
         "    esac\n"
         "}\n";
}

}  // namespace

std::vector<std::string> long_flags(const std::vector<DescribedOption>& options) {
  std::vector<std::string> flags;
  for (const DescribedOption& option : options)
    for (const std::string& flag : option.flags)
      if (flag.compare(0, 2, "--") == 0) flags.push_back(flag);
  return flags;
}

std::string shell_tables(const DescribedProgram& program, const ArrayWriter& array) {
  Meanings first;
  for (const DescribedCommand& command : program.commands)
    first.emplace_back(command.name, command.summary);
  for (const auto& flag : meanings_of(program.options)) first.push_back(flag);
  std::string script = "_traceraft_commands() {\n" + set_names(array(first)) + "}\n\n";
  script += "_traceraft_flags() {\n    case \"$1\" in\n";
  for (const DescribedCommand& command : program.commands)
    script += "        " + text::in_shell(command.name) + ")\n" +
              set_names(array(meanings_of(command.options))) + "            ;;\n";
  script += "    esac\n}\n\n";
  return script + value_function(program, array);
}

}  // namespace traceraft::manual
