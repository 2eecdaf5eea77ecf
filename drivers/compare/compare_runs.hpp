// Carries out the runs of a comparison, each a process of its own.
#pragma once

#include <filesystem>
#include <string>

#include "drivers/compare/comparison.hpp"

namespace traceraft::compare {

// A run of the same problem at a tolerance that makes its error negligible. The same one serves all
// comparisons of the same runs: its folder is named by its options and its initial state.
struct Reference {
  config::GivenValues options;  // in which it differs from the comparison's configuration
  std::filesystem::path folder;
};
inline constexpr const char* kReferenceLinearTolerance = "1e-4";

// Throws InputError if the cache holds another run of that name.
Reference reference_of(const ComparePlan& plan, const ComparisonFolder& folder,
                       const std::string& cache);

enum class WorkEnd { done, stopped, reference_failed };

// Does what the plan still lacks, the reference first. `why`: of a reference that failed. Throws
// IoError for what no method is to blame for.
WorkEnd run_comparison(const ComparePlan& plan, const ComparisonFolder& folder,
                       const Reference& reference, bool quiet, std::string& why);

}  // namespace traceraft::compare
