// The verdict of an explanation, of fields or of series: verdict.json (docs/formats.md).
#pragma once

#include "drivers/explain/explain_run.hpp"
#include "drivers/explain/found_parameters.hpp"
#include "drivers/input/json_file.hpp"

namespace traceraft::explain {

struct Verdict {
  struct Alternative {
    std::string effect;
    double score;  // 2 ln of the likelihood ratio that it gains
  };

  selection::Finding finding = selection::Finding::none;
  // Effects that explain the data as well as each other, the best first; none if nothing is named.
  std::vector<std::string> members;
  std::string closest;  // if the verdict is `unnamed`; may be ""
  std::vector<FoundParameter> parameters;
  std::vector<Alternative> alternatives;  // effects beside the base model
  // Measured minus forecast, in c; 0: not known.
  assimilation::Gaps base_gap, named_gap, runner_up_gap, floor_gap;
  int replicates = 0;
  double false_alarms = 0;
  std::optional<double> p;  // that the best effect is noise; none where none was searched for
  // Further keys of verdict.json, and of its `null`, that only one kind of data has.
  input::Json details = input::Json::object(), null_details = input::Json::object();
};

Verdict verdict_of(const selection::Explanation& found, const ExplainSetup& setup);

input::Json verdict_json(const Verdict& verdict);

// Effects of the kernel that were no candidates: left out, or not to be seen in such data.
std::vector<std::string> not_looked_for(const selection::Explanation& found);

}  // namespace traceraft::explain
