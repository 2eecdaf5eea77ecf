#include "drivers/manual/completions.hpp"

namespace traceraft {

const NamedList<ShellEntry>& shells() {
  static const NamedList<ShellEntry> list("shell", {bash_shell(), zsh_shell(), fish_shell()});
  return list;
}

}  // namespace traceraft
