// What the system knows about this process.
#pragma once

#include <string>

namespace traceraft {

double cpu_seconds();     // user and system time of all threads
double peak_memory_mb();  // largest resident set so far
bool stdout_is_terminal();
int terminal_columns();  // 80 if unknown

// From now on SIGINT and SIGTERM only set a flag; a second one ends the process at once.
void catch_stop_signals();
bool stop_requested();
// Writing beyond a file size limit becomes an error of the write instead of a signal.
void ignore_file_size_signal();

// Starts this program anew with name=value in its environment, unless the value is empty or the
// name is set already. Returns if there is nothing to do or the system refuses.
void restart_with_environment(const std::string& name, const std::string& value, char** argv);

}  // namespace traceraft
