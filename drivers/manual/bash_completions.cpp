#include "drivers/manual/completions.hpp"
#include "drivers/manual/shell_tables.hpp"
#include "drivers/text/encoders.hpp"

namespace traceraft::manual {
namespace {

std::string bash_array(const Meanings& names) {
  std::string elements;
  for (const auto& [name, meaning] : names)
    elements += (elements.empty() ? "" : " ") + text::in_shell(name);
  return elements;
}

// Offers the names that begin with the word that is being typed.
constexpr char kBashOffer[] = R"(
_traceraft_offer() {
    local name prefix=''
    [[ -n $several && $1 == *,* ]] && prefix=${1%,*},
    for name in "${names[@]}"; do
        [[ $prefix$name == "$1"* ]] && COMPREPLY+=("$prefix$name")
    done
}
)";

// Words between the command and the one that is being typed are flags, their values, or arguments.
constexpr char kBashComplete[] = R"(
_traceraft() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}
    local command=${COMP_WORDS[1]} kind=names several='' argument=1 k
    local -a names
    COMPREPLY=()
    if ((COMP_CWORD == 1)); then
        _traceraft_commands
        _traceraft_offer "$word"
        return
    fi
    # Bash takes the = of --option=value for a word of its own.
    if [[ $word == = ]]; then
        word=''
    elif [[ $before == = ]]; then
        before=${COMP_WORDS[COMP_CWORD-2]}
    fi
    if [[ $before == --* ]] && _traceraft_value "$command" "$before"; then
        :
    elif [[ $word == -* ]]; then
        _traceraft_flags "$command"
    else
        for ((k = 2; k < COMP_CWORD; ++k)); do
            if [[ ${COMP_WORDS[k]} != -* ]]; then
                ((++argument))
            elif _traceraft_value "$command" "${COMP_WORDS[k]}"; then
                [[ ${COMP_WORDS[k+1]} == = ]] && ((++k))
                ((++k))
            fi
        done
        _traceraft_value "$command" "argument $argument" || _traceraft_flags "$command"
    fi
    case $kind in
        names) _traceraft_offer "$word" ;;
        files) compopt -o default ;;
        folders) compopt -o dirnames ;;
    esac
}
complete -F _traceraft traceraft
)";

std::string bash_completions(const DescribedProgram& program) {
  return "# Completes the command line of traceraft in bash: traceraft completions bash\n\n" +
         shell_tables(program, bash_array) + kBashOffer + kBashComplete;
}

}  // namespace

ShellEntry bash_shell() {
  return {"bash", bash_completions};
}

}  // namespace traceraft::manual
