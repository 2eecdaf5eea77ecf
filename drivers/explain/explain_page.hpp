// The page of an explanation: verdict, where, what, and how the gap shrinks.
#pragma once

#include <filesystem>

#include "drivers/explain/explain_run.hpp"

namespace traceraft::explain {

// Writes explain.html, self-contained, with its charts beside it. Returns what is missing, "" if
// nothing. Throws IoError.
std::string write_explain_page(const std::filesystem::path& folder,
                               const selection::Explanation& found, const ExplainSetup& setup);

}  // namespace traceraft::explain
