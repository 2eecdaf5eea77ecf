// Variance components: noise whose covariance is a sum of known matrices with unknown variances.
//
// By weighted second moments of the values, Rao's (1971) MINQUE, iterated. Where the weights are
// the inverse covariance that is maximum likelihood; here the nugget in them is larger than that of
// the noise. Noise that is smooth has next to no variance over short distances, and the likelihood
// would be that of its shape there; what matters is how much of it there is over long ones.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "kernel/core/thread_team.hpp"
#include "verification/assimilation/filter/noise_blocks.hpp"

namespace traceraft::assimilation {

// Correlation of two different values as a function of their distance.
using CorrelationFunction = std::function<double(double distance)>;

struct VarianceFit {
  Vec variances;               // of each component, in units of the blocks' deviations
  Eigen::MatrixXd covariance;  // of the estimates; 0 where variances are 0
  double standard_error(Eigen::Index k) const { return std::sqrt(std::max(0.0, covariance(k, k))); }
};

class VarianceComponents {
 public:
  // Both must outlive this object. Does not depend on the size of the team.
  VarianceComponents(const std::vector<NoiseBlock>& blocks, const ThreadTeam& team,
                     std::vector<CorrelationFunction> components)
      : blocks_(blocks), team_(team), components_(std::move(components)) {}

  // The variances of the components that are `free`, the others being 0. Weights begin with those
  // of `start`. None of the variances is negative.
  VarianceFit fit(const Vec& start, const std::vector<bool>& free) const;

  // The fall of −2 ln of the likelihood, to second order, from the most probable variances of some
  // components, if those that are `free` came to it (Rao's score test).
  double score_gain(const Vec& at, const std::vector<bool>& free) const;

 private:
  // Moments of the values y, with weights W, for the matrices A (and B) of the free components.
  struct Moments {
    Vec measured,            // vᵀ A v with v = W y, one per free component
        known;               // its expectation by what is known, K: tr W A W K
    Eigen::MatrixXd matrix;  // tr W A W B, free components × free components
  };
  Eigen::MatrixXd component(const NoiseBlock& block, std::size_t k) const;
  Moments moments(const Vec& variances, double extra_nugget,
                  const std::vector<Eigen::Index>& free) const;
  Moments moments(const NoiseBlock& block, const Vec& variances, double extra_nugget,
                  const std::vector<Eigen::Index>& free) const;

  const std::vector<NoiseBlock>& blocks_;
  const ThreadTeam& team_;
  const std::vector<CorrelationFunction> components_;
};

}  // namespace traceraft::assimilation
