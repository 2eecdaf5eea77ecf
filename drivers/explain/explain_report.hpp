// What `explain` has found, as files and words.
#pragma once

#include <filesystem>

#include "drivers/config/configuration.hpp"
#include "verification/explain/explanation.hpp"

namespace traceraft {

// verdict.json, scores.csv, disagreements.csv and, if something was named that a second run did not
// refute, model.toml. `model`: with the radius of the vesicle. Throws IoError.
void write_explanation(const std::filesystem::path& folder, const Explanation& found,
                       const GivenValues& model);

void print_explanation(const Explanation& found, const GivenValues& model);

}  // namespace traceraft
