#include "verification/assimilation/filter/variance_components.hpp"

#include <Eigen/Dense>

#include "backends/openblas/dense_algebra.hpp"

namespace traceraft::assimilation {
namespace {

// The extra nugget in the weights, over the sum of all variances.
constexpr double kExtraNugget = 0.25;
constexpr int kMostWeightings = 12;
// Variances that change by less than that share of their sum are settled.
constexpr double kScored = 2e-3;

BlockRows indices(const std::vector<bool>& chosen) {
  BlockRows result;
  for (std::size_t k = 0; k < chosen.size(); ++k)
    if (chosen[k]) result.push_back(static_cast<Eigen::Index>(k));
  return result;
}

// The least of xᵀ A x − 2 bᵀ x over x ≥ 0: the face that it lies on is found by holding what would
// be negative, and freeing what would grow (Lawson and Hanson 1974).
Vec least_without_negative(const Eigen::MatrixXd& A, const Vec& b) {
  const Eigen::Index n = b.size();
  std::vector<bool> positive(static_cast<std::size_t>(n), false);
  Vec x = Vec::Zero(n);
  for (Eigen::Index step = 0; step < 3 * n; ++step) {
    const Vec slope = b - A * x;
    Eigen::Index enters = -1;
    double most = 1e-9 * b.cwiseAbs().maxCoeff();
    for (Eigen::Index k = 0; k < n; ++k)
      if (!positive[static_cast<std::size_t>(k)] && slope[k] > most) {
        most = slope[k];
        enters = k;
      }
    if (enters < 0) break;
    positive[static_cast<std::size_t>(enters)] = true;
    for (bool inside = false; !inside;) {
      const BlockRows free = indices(positive);
      const Vec part = Eigen::MatrixXd(A(free, free)).ldlt().solve(Vec(b(free)));
      double share = 1;
      for (std::size_t k = 0; k < free.size(); ++k)
        if (const double to = part[static_cast<Eigen::Index>(k)]; to <= 0)
          share = std::min(share, x[free[k]] / (x[free[k]] - to));
      inside = share >= 1;
      for (std::size_t k = 0; k < free.size(); ++k) {
        double& value = x[free[k]];
        value += share * (part[static_cast<Eigen::Index>(k)] - value);
        if (inside || value > 1e-12) continue;
        value = 0;
        positive[static_cast<std::size_t>(free[k])] = false;
      }
    }
  }
  return x;
}

}  // namespace

Eigen::MatrixXd VarianceComponents::component(const NoiseBlock& block, std::size_t k) const {
  const Eigen::Index n = block.values.size();
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < j; ++i)
      result(i, j) = result(j, i) =
          block.deviation[i] * block.deviation[j] * components_[k](block.distance(i, j));
    result(j, j) = block.deviation[j] * block.deviation[j];
  }
  return result;
}

VarianceComponents::Moments VarianceComponents::moments(const NoiseBlock& block,
                                                        const Vec& variances, double extra_nugget,
                                                        const BlockRows& free) const {
  Eigen::MatrixXd V = block.known;
  V.diagonal() += extra_nugget * block.deviation.cwiseAbs2();
  for (std::size_t k = 0; k < components_.size(); ++k)
    if (const double variance = variances[static_cast<Eigen::Index>(k)]; variance > 0)
      V += variance * component(block, k);
  const Eigen::MatrixXd L = openblas::cholesky_factor(V);
  const Vec weighted = openblas::divided_by_factors(L, block.values).col(0);
  const Eigen::MatrixXd known = openblas::divided_by_factors(L, block.known);
  const auto n = static_cast<Eigen::Index>(free.size());
  std::vector<Eigen::MatrixXd> solved;
  Moments result{Vec(n), Vec(n), Eigen::MatrixXd(n, n)};
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::MatrixXd A = component(block, static_cast<std::size_t>(free[j]));
    solved.push_back(openblas::divided_by_factors(L, A));
    result.measured[j] = weighted.dot(A * weighted);
    result.known[j] = solved.back().cwiseProduct(known.transpose()).sum();
    for (Eigen::Index k = 0; k <= j; ++k)
      result.matrix(j, k) = result.matrix(k, j) =
          solved.back().cwiseProduct(solved[k].transpose()).sum();
  }
  return result;
}

VarianceComponents::Moments VarianceComponents::moments(const Vec& variances, double extra_nugget,
                                                        const BlockRows& free) const {
  std::vector<Moments> parts(blocks_.size());
  team_.for_range(blocks_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      parts[b] = moments(blocks_[b], variances, extra_nugget, free);
  });
  const auto n = static_cast<Eigen::Index>(free.size());
  Moments sum{Vec::Zero(n), Vec::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  for (const Moments& part : parts) {
    sum.measured += part.measured;
    sum.known += part.known;
    sum.matrix += part.matrix;
  }
  return sum;
}

VarianceFit VarianceComponents::fit(const Vec& start, const std::vector<bool>& free) const {
  const BlockRows own = indices(free);
  VarianceFit result{start, Eigen::MatrixXd::Zero(start.size(), start.size())};
  Eigen::MatrixXd matrix;
  for (int k = 0; k < kMostWeightings; ++k) {
    const double sum = result.variances.sum();
    const Moments here = moments(result.variances, kExtraNugget * sum, own);
    matrix = here.matrix;
    Vec next = Vec::Zero(start.size());
    next(own) = least_without_negative(here.matrix, here.measured - here.known);
    if (next.sum() <= 0) break;  // what is known is more than all that was measured
    const double change = (next - result.variances).cwiseAbs().maxCoeff();
    result.variances = next;
    if (change < kScored * sum) break;
  }
  BlockRows positive;
  for (std::size_t k = 0; k < own.size(); ++k)
    if (result.variances[own[k]] > 0) positive.push_back(static_cast<Eigen::Index>(k));
  const auto n = static_cast<Eigen::Index>(positive.size());
  const Eigen::MatrixXd inverse =
      Eigen::MatrixXd(matrix(positive, positive)).ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  for (Eigen::Index k = 0; k < n; ++k)
    for (Eigen::Index j = 0; j < n; ++j)
      result.covariance(own[positive[k]], own[positive[j]]) = 2 * inverse(k, j);
  return result;
}

// There the score is half of what is measured beyond what is expected.
double VarianceComponents::score_gain(const Vec& at, const std::vector<bool>& free) const {
  const BlockRows own = indices(free);
  const Moments here = moments(at, 0, own);
  const Vec load = here.measured - here.known;
  const Vec now = at(own), best = least_without_negative(here.matrix, load);
  const auto square = [&](const Vec& x) { return x.dot(here.matrix * x) - 2 * load.dot(x); };
  return 0.5 * (square(now) - square(best));
}

}  // namespace traceraft::assimilation
