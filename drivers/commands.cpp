#include "drivers/commands.hpp"

namespace traceraft {

const NamedList<Command>& commands() {
  static const NamedList<Command> list(
      "command", {run_command(), resume_command(), compare_command(), verify_command(),
                  ensemble_command(), data_command(), report_command(), calibrate_command(),
                  explain_command(), hide_command(), campaign_command(), fraction_command(),
                  list_command(), man_command(), completions_command()});
  return list;
}

}  // namespace traceraft
