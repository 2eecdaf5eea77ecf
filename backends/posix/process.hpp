// What the system knows about this process.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace traceraft {

double wall_seconds();    // since this process started
double cpu_seconds();     // user and system time of all threads
double peak_memory_mb();  // largest resident set so far
bool stdout_is_terminal();
int terminal_columns();  // 80 if unknown

// From now on SIGINT and SIGTERM only set a flag; a second one ends the process at once.
void catch_stop_signals();
bool stop_requested();
// Writing beyond a file size limit becomes an error of the write instead of a signal.
void ignore_file_size_signal();

// Starts this program anew with these variables in its environment, unless all are set already.
// Values that the user has set are kept. Returns if there is nothing to do or the system refuses.
void restart_with_environment(const std::vector<std::pair<std::string, std::string>>& variables,
                              char** argv);

}  // namespace traceraft
