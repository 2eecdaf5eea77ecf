#include "drivers/manual/completions.hpp"
#include "drivers/manual/shell_tables.hpp"
#include "drivers/text/encoders.hpp"

namespace traceraft::manual {
namespace {

// Elements that _describe reads: a name, a colon and what is shown beside it.
std::string zsh_array(const Meanings& names) {
  std::string elements;
  for (const auto& [name, meaning] : names) {
    std::string text;
    for (const char ch : name) text += (ch == ':' || ch == '\\' ? "\\" : "") + std::string(1, ch);
    elements +=
        "\n                " + text::in_shell(meaning.empty() ? text : text + ":" + meaning);
  }
  return elements;
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
  return "#compdef traceraft\n"
         "# Completes the command line of traceraft in zsh: traceraft completions zsh\n\n" +
         shell_tables(program, zsh_array) + kZshComplete;
}

}  // namespace

ShellEntry zsh_shell() {
  return {"zsh", zsh_completions};
}

}  // namespace traceraft::manual
