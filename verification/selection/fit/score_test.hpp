// How much better each candidate explains a series than the model without it, and how much of that
// is to be expected of noise.
#pragma once

#include "verification/assimilation/filter/field_filter.hpp"

namespace traceraft::selection {

// p = (1 + the number of replicates that reach it) / (1 + their number).
double share_of_noise(const Vec& replicates, double value);

// p beyond what so few replicates can count, for sums of many squares: that of the gamma
// distribution with their mean and variance (Satterthwaite 1946).
double gamma_tail(const Vec& replicates, double value);

struct CandidateScore {
  std::string effect;
  // Most probable ones, to first order, within their signs. The variance of a random effect is that
  // without errors of the model, which the score allows for: they may look like it.
  std::vector<double> coefficients;
  // 2 ln of the likelihood gained, to first order. Diffusion ratio and mesh error are free.
  double score;
  double null_mean;  // `score` of noise alone, on average over the replicates, half a unit at least
  // Share of replicates in which any candidate gains as much, in units of its own average.
  double p;
  double response;  // root mean square change of c that it makes, in units of the noise
  // Covariance of the coefficients, coefficients × coefficients, nuisances being free. It is 0 for
  // those on which nothing that was measured depends in a way of its own.
  Eigen::MatrixXd covariance;
  double resolution;  // response to one standard deviation of the coefficient that is known best
};

// An effect that only makes the mobility larger, so that D makes up for nearly all of it: data know
// D (1 + slope · strength), to first order, and little of the two by themselves.
struct ConfoundedWithDiffusionRatio {
  std::string effect;
  double slope;        // ∂ ln D/∂ strength along which next to nothing that is measured changes
  double correlation;  // of the two responses, all else being at its best
};
inline constexpr double kConfounded = 0.9;

struct Screening {
  std::vector<CandidateScore> scores;  // most probable first
  double p = 1;                        // that the most telling of them is noise
  // Probabilities of a gap of any shape by noise alone, nuisances being at their best.
  double train_gap_p = 1,         // in the snapshots that count
      heldout_gap_p = 1,          // in those that are held out; 1 if none is
      gap_p = 1;                  // in both
  double diffusion_ratio_change,  // the change of ln D, if nothing else is missing
      diffusion_ratio_deviation;  // its standard deviation
  double mesh_error;              // root mean square of what a finer mesh changes, in noise
  std::vector<ConfoundedWithDiffusionRatio> confounded = {};  // correlated by more than kConfounded
};

// `known`: the hypothesis of the model whose pass the result is.
Screening screen(const assimilation::FilterResult& result,
                 const std::vector<assimilation::Candidate>& screened,
                 const assimilation::Hypothesis& known);

}  // namespace traceraft::selection
