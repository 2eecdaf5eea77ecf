// The findings of `explain`, as files and words.
#pragma once

#include <filesystem>

#include "drivers/explain/explain_run.hpp"

namespace traceraft::explain {

// verdict.json, scores.csv, disagreements.csv and, if something was named that a second run did not
// refute, model.toml. Throws IoError.
void write_explanation(const std::filesystem::path& folder, const selection::Explanation& found,
                       const ExplainSetup& setup);

void print_explanation(const selection::Explanation& found, const ExplainSetup& setup);

// The command that runs the model with what was found, over the measured time; "" for none.
std::string command_for_found(const std::filesystem::path& folder,
                              const selection::Explanation& found, const ExplainSetup& setup);

}  // namespace traceraft::explain
