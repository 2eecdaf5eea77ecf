// The subcommands of traceraft: one registration list.
#pragma once

#include <functional>
#include <string>

#include "kernel/core/named_list.hpp"

namespace CLI {
class App;
}

namespace traceraft {

// Carries out what the command line asks for. Returns an exit code; throws InputError, IoError or
// LockedError.
using Action = std::function<int()>;

enum class Ranks { one, several, starts_them };

struct Command {
  std::string name, summary;
  Ranks ranks;  // what it works on; one that starts processes of MPI itself is not to run below
                // mpirun
  // Adds its flags to the parser, and says what to do once they have been read.
  std::function<Action(CLI::App&)> define;
};

const NamedList<Command>& commands();

Command run_command();
Command resume_command();
Command compare_command();
Command verify_command();
Command ensemble_command();
Command data_command();
Command report_command();
Command calibrate_command();
Command explain_command();
Command hide_command();
Command campaign_command();
Command fraction_command();
Command list_command();
Command man_command();
Command completions_command();

}  // namespace traceraft
