// Complaints about flags and folders that are given as an empty text. Most often a variable of a
// shell script is not set.
#pragma once

#include <CLI/CLI.hpp>

namespace traceraft::config {

// Every option of the command that takes a value refuses "", unless it is one of a run for which
// that means something (--effect "": none).
void refuse_empty_texts(CLI::App& command);

}  // namespace traceraft::config
