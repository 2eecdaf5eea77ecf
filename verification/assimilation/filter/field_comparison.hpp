// A forecast held against the snapshot that it is of.
#pragma once

#include "verification/assimilation/filter/filter_problem.hpp"
#include "verification/assimilation/filter/innovation.hpp"

namespace traceraft::assimilation {

// What is known of c, and how it depends on what is not.
struct Belief {
  Vec c;
  Columns errors;      // L: covariance L Lᵀ
  Columns parameters;  // ∂c/∂θ
  Columns replicates;  // errors of the replicates
};

struct FieldComparison {
  Innovation in{};
  Columns fields;              // what moves along the directions; by a scale or a zero nothing does
  Eigen::Index known, frames;  // of the directions: errors of the forecast, then of the frame
};

// `forecast`: of that snapshot, at least the second one; `mesh`: what its own mesh lacks. The
// innovation is as it is before its amplitudes are known: without frame, gap and weighted squares.
FieldComparison compare_field(const FilterProblem& data, const problem::CahnHilliard& problem,
                              const FilterSettings& settings, const Belief& forecast,
                              std::size_t snapshot, const ResolvedForecast::End& mesh);

}  // namespace traceraft::assimilation
