// A search that goes on, in the same folder, where an earlier process left off.
#pragma once

#include <filesystem>

#include "drivers/explain/explain_run.hpp"

namespace traceraft::explain {

// Finds what is missing and tries it on another mesh. The folder, which exists, keeps every refit
// (search.json), and what was found before and after that second run (write_explanation). Takes
// request.save for itself. Throws InputError if the folder holds another search, NumericalFailure,
// IoError.
selection::Explanation search_resumably(const std::filesystem::path& folder, ExplainSetup& setup);

}  // namespace traceraft::explain
