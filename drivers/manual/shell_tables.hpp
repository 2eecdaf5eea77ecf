// The tables of the completions in bash and zsh: which words may stand where on the command line.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/manual/description.hpp"

namespace traceraft::manual {

// "--cells", "--fields" and "--no-fields", without one-letter flags.
std::vector<std::string> long_flags(const std::vector<DescribedOption>& options);

// A name and what it means, "" if nothing is said of it.
using Meanings = std::vector<std::pair<std::string, std::string>>;
// Writes names as elements of an array of a shell.
using ArrayWriter = std::function<std::string(const Meanings&)>;

// Functions of a script of bash or zsh, all of which set `kind`, `several` and `names`.
// _traceraft_commands: what the first word may be. _traceraft_flags, asked for "run": its options.
// _traceraft_value, asked for "run" and "--case" or for "data" and "argument 1": what stands there;
// it fails if nothing may.
std::string shell_tables(const DescribedProgram& program, const ArrayWriter& array);

}  // namespace traceraft::manual
