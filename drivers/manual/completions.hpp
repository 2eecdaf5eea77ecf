// Scripts that make a shell complete the command line: commands, options, and values that are known
// by name.
#pragma once

#include <functional>
#include <string>

#include "drivers/manual/description.hpp"
#include "kernel/core/named_list.hpp"

namespace traceraft::manual {

struct ShellEntry {
  std::string name;
  std::function<std::string(const DescribedProgram&)> completions;
};

ShellEntry bash_shell();
ShellEntry zsh_shell();
ShellEntry fish_shell();

const NamedList<ShellEntry>& shells();

}  // namespace traceraft::manual
