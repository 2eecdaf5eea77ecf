#include "drivers/manual/value_groups.hpp"

#include <algorithm>

#include "drivers/text/encoders.hpp"
#include "kernel/core/text.hpp"

namespace traceraft {
namespace {

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

}  // namespace

std::vector<ValueGroup> value_groups(const DescribedProgram& program) {
  std::vector<ValueGroup> groups;
  for (const DescribedCommand& command : program.commands) {
    for (std::size_t k = 0; k < command.positionals.size(); ++k) {
      const DescribedOption& positional = command.positionals[k];
      const std::string argument = command.name + " argument ";
      add_pattern(groups, positional.placeholder,
                  positional.repeated ? in_shell(argument) + "*"
                                      : in_shell(argument + std::to_string(k + 1)));
    }
    for (const DescribedOption& option : command.options)
      if (option.takes_value())
        for (const std::string& flag : long_flags({option}))
          add_pattern(groups, option.placeholder, in_shell(command.name + " " + flag));
  }
  return groups;
}

std::vector<std::string> long_flags(const std::vector<DescribedOption>& options) {
  std::vector<std::string> flags;
  for (const DescribedOption& option : options)
    for (const std::string& flag : option.flags)
      if (flag.compare(0, 2, "--") == 0) flags.push_back(flag);
  return flags;
}

std::string value_function(const DescribedProgram& program,
                           const std::function<std::string(const std::string&)>& array) {
  std::string script =
      "# What may follow an option or be an argument of a command. Fails if nothing may.\n"
      "_traceraft_value() {\n"
      "    kind=names several='' names=()\n"
      "    case \"$1 $2\" in\n";
  for (const ValueGroup& group : value_groups(program)) {
    const OfferedValues offered = offered_values(group.placeholder);
    script += "        " + joined(group.patterns, " | \\\n        ") + ")\n";
    script += "            kind=" + std::string(kind_word(offered.kind));
    if (offered.several) script += " several=,";
    if (!offered.names.empty()) script += "\n            names=(" + array(group.placeholder) + ")";
    script += " ;;\n";
  }
  return script +
         "        *) return 1 ;;\n"
         "    esac\n"
         "}\n";
}

}  // namespace traceraft
