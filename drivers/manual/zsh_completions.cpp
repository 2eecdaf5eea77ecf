#include <utility>

#include "drivers/manual/completions.hpp"
#include "drivers/manual/value_groups.hpp"
#include "drivers/text/encoders.hpp"

namespace traceraft {
namespace {

// An element of an array that _describe reads: a name, a colon and what is shown beside it.
std::string zsh_element(const std::string& name, const std::string& meaning) {
  std::string text;
  for (const char ch : name) text += (ch == ':' || ch == '\\' ? "\\" : "") + std::string(1, ch);
  if (!meaning.empty()) text += ":" + meaning;
  return "\n        " + in_shell(text);
}

std::string zsh_elements(const std::string& placeholder) {
  const OfferedValues offered = offered_values(placeholder);
  std::string elements;
  for (const ValueList& list : value_lists())
    if (list.name == placeholder || list.name + ",..." == placeholder) {
      for (const auto& [name, meaning] : list.values) elements += zsh_element(name, meaning);
      return elements;
    }
  for (const std::string& name : offered.names) elements += zsh_element(name, "");
  return elements;
}

std::string zsh_elements(const std::vector<DescribedOption>& options) {
  std::string elements;
  for (const DescribedOption& option : options)
    for (const std::string& flag : long_flags({option})) elements += zsh_element(flag, option.help);
  return elements;
}

std::string zsh_flags(const DescribedProgram& program) {
  std::string script =
      "_traceraft_flags() {\n"
      "    kind=names several='' names=()\n"
      "    case \"$1\" in\n";
  for (const DescribedCommand& command : program.commands)
    script += "        " + in_shell(command.name) + ") names=(" + zsh_elements(command.options) +
              ") ;;\n";
  return script + "    esac\n}\n";
}

constexpr char kZshComplete[] = R"(
_traceraft() {
    local word=$words[CURRENT] before=$words[CURRENT-1] command=$words[2]
    local kind=names several='' argument=1 k
    local -a names
    if ((CURRENT == 2)); then
        _traceraft_commands
        _describe -t commands command names
        return
    fi
    if [[ $word == --*=* ]]; then
        before=${word%%=*}
        compset -P 1 '*='
    fi
    if [[ $before == --* ]] && _traceraft_value $command $before; then
        :
    elif [[ $word == -* ]]; then
        _traceraft_flags $command
    else
        for ((k = 3; k < CURRENT; ++k)); do
            if [[ $words[k] != -* ]]; then
                ((++argument))
            elif [[ $words[k] != *=* ]] && _traceraft_value $command $words[k]; then
                ((++k))
            fi
        done
        _traceraft_value $command "argument $argument" || _traceraft_flags $command
    fi
    case $kind in
        names)
            [[ -n $several ]] && compset -P '*,'
            _describe -t values value names ;;
        files) _files ;;
        folders) _files -/ ;;
    esac
}
_traceraft "$@"
)";

std::string zsh_completions(const DescribedProgram& program) {
  std::string first;
  for (const DescribedCommand& command : program.commands)
    first += zsh_element(command.name, command.summary);
  return "#compdef traceraft\n"
         "# Completes the command line of traceraft in zsh: traceraft completions zsh\n\n"
         "_traceraft_commands() {\n    names=(" +
         first + zsh_elements(program.options) + ")\n}\n\n" + zsh_flags(program) + "\n" +
         value_function(program,
                        [](const std::string& placeholder) { return zsh_elements(placeholder); }) +
         kZshComplete;
}

}  // namespace

ShellEntry zsh_shell() {
  return {"zsh", zsh_completions};
}

}  // namespace traceraft
