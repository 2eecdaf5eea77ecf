// This process as the system knows it.
#pragma once

#include <csignal>
#include <string>
#include <utility>
#include <vector>

namespace traceraft::posix {

double wall_seconds();        // since this program was started, libraries still to be loaded
double cpu_seconds();         // user and system time of all threads
double thread_cpu_seconds();  // of the calling thread
double peak_memory_mb();      // largest resident set so far
bool is_superuser();
bool stdout_is_terminal();
int terminal_columns();  // 80 if unknown

// The signal to a child whose starter dies (child.hpp), perhaps sent several times.
inline constexpr int kParentDied = SIGUSR1;

// From now on SIGINT, SIGTERM, kParentDied and, unless it is ignored, SIGHUP only set a flag;
// another SIGINT or SIGTERM, two seconds or more after the first, ends the process at once. Threads
// that are older than this may not run METIS, which puts a handler of its own.
void catch_stop_signals();
bool stop_requested();
// From now on they end the process at once, with this exit code and a line on stderr: for work
// whose results are safe at any moment. Until catch_stop_signals is called.
void end_on_stop_signals(int exit_code, const std::string& line);
// In a child, before it becomes another program: they do again what they do by default. Safe after
// a fork.
void default_stop_signals();
// Nobody reads the output any longer: the same as the end of a terminal, SIGHUP.
void hang_up();
// Writing beyond a file size limit becomes an error of the write instead of a signal.
void ignore_file_size_signal();
// Standard input, output or error that are closed would be given to the next file that is opened,
// which would then receive messages. From now on their descriptors are taken, and using them fails.
void occupy_standard_descriptors();

// Starts this program anew with these variables in its environment, unless all are set already.
// Values that the user has set are kept. Returns if there is nothing to do or the system refuses.
void restart_with_environment(const std::vector<std::pair<std::string, std::string>>& variables,
                              char** argv);

}  // namespace traceraft::posix
