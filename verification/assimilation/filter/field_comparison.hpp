// A forecast held against the snapshot that it is of.
#pragma once

#include "verification/assimilation/filter/filter_problem.hpp"
#include "verification/assimilation/filter/innovation.hpp"

namespace traceraft::assimilation {

// The fields that a random effect may have added since the snapshot before, at the variance 1.
struct RandomFields {
  Eigen::Index parameter;  // the place of the variance among the parameters
  double variance;         // that the errors of the belief have it with
  Columns fields;          // nodes × noises
};

// Knowledge of c at the nodes, and how it depends on what is not known.
struct Belief {
  Vec c;                                  // the most probable one
  Columns errors;                         // L, nodes × directions: covariance L Lᵀ
  Columns parameters;                     // ∂c/∂θ, nodes × parameters
  Columns replicates;                     // errors of the replicates, nodes × replicates
  std::vector<RandomFields> random = {};  // since the snapshot before
};

struct FieldComparison {
  Innovation in{};
  // Nodes × directions: the change of the state along each of them; 0 for a scale or a zero.
  Columns fields;
  Eigen::Index known,  // number of the first directions, those of the errors of the forecast
      frames;          // number of the next ones, those of the frame
};

// `forecast`: of that snapshot, at least the second one; `mesh`: what its own mesh lacks. The
// innovation is as it is before its amplitudes are known: without frame, gap and weighted squares.
FieldComparison compare_field(const FilterProblem& data, const problem::CahnHilliard& problem,
                              const FilterSettings& settings, const Belief& forecast,
                              std::size_t snapshot, const ResolvedForecast::End& mesh);

}  // namespace traceraft::assimilation
