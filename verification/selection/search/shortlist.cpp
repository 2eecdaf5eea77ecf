#include "verification/selection/search/shortlist.hpp"

#include <algorithm>
#include <cmath>

#include "verification/selection/search/judgement.hpp"

namespace traceraft::selection {
namespace {

constexpr double kWorthRefitting = 0.25;
constexpr std::size_t kAlways = 2;  // the best one, and one to compare it with

}  // namespace

std::vector<assimilation::Hypothesis::Part> shortlist(const Screening& screening, std::size_t size,
                                                      double limit) {
  std::vector<assimilation::Hypothesis::Part> result;
  const double most = screening.scores.empty() ? 0 : screening.scores.front().score;
  // The score from which on candidates are refitted: those that might explain the data as well, and
  // more, as first orders underestimate.
  const double least = std::min(std::max(kTelling, kWorthRefitting * most), most - limit);
  std::size_t gaining = 0;
  for (const CandidateScore& score : screening.scores) {
    const assimilation::Candidate candidate = assimilation::find_candidate(score.effect).value();
    const bool gains = gaining < kAlways || (gaining < size && score.score >= least);
    if (gains) ++gaining;
    if (!gains && !(candidate.like_diffusion_ratio && score.covariance(0, 0) > 0)) continue;
    result.push_back({candidate, score.coefficients});
    // From where it does nothing there may be no way on.
    if (candidate.like_diffusion_ratio && score.score == 0)
      result.back().coefficients[0] = std::sqrt(score.covariance(0, 0));
  }
  return result;
}

}  // namespace traceraft::selection
