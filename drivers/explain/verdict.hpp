// What a search has found, for programs.
#pragma once

#include "drivers/explain/explain_run.hpp"
#include "drivers/explain/found_parameters.hpp"
#include "drivers/input/json_file.hpp"

namespace traceraft {

// Effects of the kernel that were no candidates: left out, or not to be seen in such data.
std::vector<std::string> not_looked_for(const Explanation& found);

// {effect.parameter: {value, sigma, unit}}, D without an effect.
Json parameters_json(const std::vector<FoundParameter>& found);

// verdict.json (docs/formats.md).
Json verdict_json(const Explanation& found, const ExplainSetup& setup);

}  // namespace traceraft
