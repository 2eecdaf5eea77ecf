// What `explain` has found, as files and words.
#pragma once

#include <filesystem>
#include <string>

#include "drivers/config/configuration.hpp"
#include "verification/explain/explanation.hpp"

namespace traceraft {

// The effects of a hypothesis as --effect takes them, with units of the given configuration.
std::string effect_text(const Hypothesis& hypothesis, const Units& units);

// verdict.json, scores.csv, disagreements.csv and, if something was named, model.toml: the model
// with the effects and the diffusion that were found, as `traceraft run --config` takes it.
// `model`: with the radius of the vesicle. Throws IoError.
void write_explanation(const std::filesystem::path& folder, const Explanation& found,
                       const GivenValues& model);

void print_explanation(const Explanation& found, const GivenValues& model);

}  // namespace traceraft
