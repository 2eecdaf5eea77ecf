// How much better each candidate explains a series than the model without it, and how much of that
// is to be expected of noise.
#pragma once

#include "verification/explain/field_filter.hpp"

namespace traceraft {

struct CandidateScore {
  std::string effect;
  std::vector<double> coefficients;  // most probable ones, to first order, within their signs
  double score;      // 2 ln of the likelihood gained, to first order; pace and mesh error are free
  double null_mean;  // the same of noise alone, on average over the replicates
  double p;          // share of replicates in which any candidate gains more, in units of its own
                     // average
  double response;   // root mean square change of c that it makes, in units of the noise
};

struct Screening {
  std::vector<CandidateScore> scores;  // most probable first
  double p = 1;                        // that the most telling of them is noise
  double gap_p = 1;  // that there is a gap of any shape is noise, nuisances being at their best
  double pace_change, pace_deviation;  // of ln D, if nothing else is missing
  double mesh_error;                   // root mean square of what a finer mesh changes, in noise
};

Screening screen(const FilterResult& result, const std::vector<Candidate>& screened,
                 Eigen::Index known_coefficients);

}  // namespace traceraft
