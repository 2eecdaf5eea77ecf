#include "drivers/commands.hpp"

namespace traceraft::drivers {

const NamedList<Command>& commands() {
  static const NamedList<Command> list(
      "command",
      {run::run_command(), run::resume_command(), compare::compare_command(),
       verify::verify_command(), ensemble::ensemble_command(), data::data_command(),
       report::report_command(), calibrate::calibrate_command(), explain::explain_command(),
       campaign::hide_command(), campaign::campaign_command(), data::fraction_command(),
       list_command(), manual::man_command(), manual::completions_command()});
  return list;
}

}  // namespace traceraft::drivers
