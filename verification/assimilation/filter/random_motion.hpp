// Random effects as errors of forecasts: from one snapshot to the next they add independent fields
// of known shapes to the state. How large these are is a variance, which is estimated.
#pragma once

#include <vector>

#include "verification/assimilation/filter/field_comparison.hpp"
#include "verification/assimilation/forecast/candidates.hpp"

namespace traceraft::assimilation {

// The random ones among some candidates are what forecasts of these data may be asked about.
void set_random_effects(const std::vector<Candidate>& candidates,
                        const problem::CahnHilliardModel& base, FilterProblems& data);

// One that a filter works with.
struct RandomPart {
  std::size_t effect;      // its place in FilterProblem::random
  double variance;         // over that of the unit effect
  Eigen::Index parameter;  // the place of the variance among the parameters
};

// Those of a hypothesis, and of candidates beside it, whose variance is 0.
std::vector<RandomPart> random_parts(const FilterProblem& data, const Hypothesis& hypothesis,
                                     const std::vector<Candidate>& screened);

// What the unit effect adds to a state along a way: independent noises in each step of a path, as
// they have relaxed by its end. Nodes × at most `most` fields, those that matter most.
Columns noises_at_end(const FilterProblem& data, const problem::RandomEffect& effect,
                      const TangentPath& along, int most, TangentFlow& flow);

// With values ν of the covariance S, which has a variance times G Gᵀ in it: the derivative of ln of
// the likelihood by the variance, and the mean of its square,
//   ½ (|Gᵀ S⁻¹ ν|² − tr Gᵀ S⁻¹ G)   and   ½ |Gᵀ S⁻¹ G|².
struct VarianceScore {
  Vec scores;  // of each column of the values
  double information;
};
VarianceScore variance_score(const InnovationCovariance& weight, const Columns& G,
                             const Columns& values);

// 2 ln of the likelihood that the variances of an innovation, as they are in S, gain over 0; and
// the mean and the variance of that if S is the covariance.
struct VarianceGain {
  double gain = 0, mean = 0, variance = 0;
};
VarianceGain variance_gain(const Innovation& innovation, const InnovationCovariance& weight);

}  // namespace traceraft::assimilation
