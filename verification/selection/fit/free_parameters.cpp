#include "verification/selection/fit/free_parameters.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace traceraft::selection {
namespace {

bool leaves_range(const assimilation::Candidate& candidate, double coefficient, double step) {
  return (coefficient <= candidate.least && step < 0) ||
         (coefficient >= candidate.most && step > 0);
}

}  // namespace

Vec newton_step(const assimilation::FilterResult& pass, const std::vector<Eigen::Index>& free) {
  const Eigen::MatrixXd F = pass.information.selfadjointView<Eigen::Lower>();
  return F(free, free).ldlt().solve(Vec(pass.score(free)));
}

Eigen::MatrixXd covariance_beside_held(const Eigen::MatrixXd& information,
                                       const std::vector<Eigen::Index>& free) {
  const auto inverse = [](const Eigen::MatrixXd& A) {
    const Eigen::MatrixXd whole = A.selfadjointView<Eigen::Lower>();
    return Eigen::MatrixXd(whole.ldlt().solve(Eigen::MatrixXd::Identity(A.rows(), A.cols())));
  };
  Eigen::MatrixXd result = inverse(information).diagonal().asDiagonal();
  result(free, free) = inverse(information(free, free));
  return result;
}

std::vector<Eigen::Index> free_parameters(const assimilation::FilterResult& pass,
                                          const assimilation::Hypothesis& hypothesis) {
  std::vector<Eigen::Index> free{assimilation::kDiffusionRatio, assimilation::kMeshError};
  struct Bounded {
    const assimilation::Candidate* candidate;
    double value;
  };
  std::vector<Bounded> coefficients;
  for (const auto& part : hypothesis.parts)
    for (const double a : part.coefficients) {
      free.push_back(assimilation::kFirstParameter +
                     static_cast<Eigen::Index>(coefficients.size()));
      coefficients.push_back({&part.candidate, a});
    }
  for (bool changed = true; changed;) {
    const Vec step = newton_step(pass, free);
    changed = false;
    for (std::size_t k = 2; k < free.size() && !changed; ++k) {
      const auto& [candidate, value] = coefficients[free[k] - assimilation::kFirstParameter];
      changed = leaves_range(*candidate, value, step[static_cast<Eigen::Index>(k)]);
      if (changed) free.erase(free.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }
  return free;
}

}  // namespace traceraft::selection
