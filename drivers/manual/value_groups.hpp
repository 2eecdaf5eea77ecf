// Options of all commands by what their values may be: the tables of completions in bash and zsh.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drivers/manual/description.hpp"
#include "drivers/manual/value_lists.hpp"

namespace traceraft {

struct ValueGroup {
  std::string placeholder;
  // Of `case` in a shell: 'run --case', 'data argument 1', 'verify argument '*.
  std::vector<std::string> patterns;
};

// In the order in which the program has them.
std::vector<ValueGroup> value_groups(const DescribedProgram& program);

// "--cells", "--fields" and "--no-fields", without one-letter flags.
std::vector<std::string> long_flags(const std::vector<DescribedOption>& options);

// The function _traceraft_value of a script of bash or zsh. Asked for "run" and "--case", or for
// "data" and "argument 1", it sets `kind`, `several` and `names`, and fails if no value is taken.
// `array` writes the names of a placeholder as elements of an array.
std::string value_function(const DescribedProgram& program,
                           const std::function<std::string(const std::string&)>& array);

}  // namespace traceraft
