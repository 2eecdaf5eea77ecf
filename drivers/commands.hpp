// The subcommands of traceraft: one registration list.
#pragma once

#include <functional>
#include <string>

#include "kernel/core/named_list.hpp"

namespace CLI {
class App;
}

namespace traceraft::drivers {

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

Command list_command();

}  // namespace traceraft::drivers

// Those of the folders below.
namespace traceraft::run {
drivers::Command run_command();
drivers::Command resume_command();
}  // namespace traceraft::run
namespace traceraft::compare {
drivers::Command compare_command();
}
namespace traceraft::verify {
drivers::Command verify_command();
}
namespace traceraft::ensemble {
drivers::Command ensemble_command();
}
namespace traceraft::data {
drivers::Command data_command();
drivers::Command fraction_command();
}  // namespace traceraft::data
namespace traceraft::report {
drivers::Command report_command();
}
namespace traceraft::calibrate {
drivers::Command calibrate_command();
}
namespace traceraft::explain {
drivers::Command explain_command();
}
namespace traceraft::campaign {
drivers::Command hide_command();
drivers::Command campaign_command();
}  // namespace traceraft::campaign
namespace traceraft::manual {
drivers::Command man_command();
drivers::Command completions_command();
}  // namespace traceraft::manual
