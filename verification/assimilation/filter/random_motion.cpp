#include "verification/assimilation/filter/random_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "backends/openblas/dense_algebra.hpp"

namespace traceraft::assimilation {
namespace {

std::shared_ptr<const problem::RandomEffect> unit_effect(const problem::CahnHilliardModel& base,
                                                         const Candidate& candidate) {
  return std::dynamic_pointer_cast<const problem::RandomEffect>(
      effects::with_effects(base, {candidate.term({1.0})}).effects.back());
}

std::size_t place_of(const std::string& name, const FilterProblem& data) {
  const auto found =
      std::find_if(data.random.begin(), data.random.end(),
                   [&](const FilterProblem::Random& random) { return random.name == name; });
  if (found == data.random.end()) throw std::logic_error("forecasts were not asked about " + name);
  return static_cast<std::size_t>(found - data.random.begin());
}

}  // namespace

void set_random_effects(const std::vector<Candidate>& candidates,
                        const problem::CahnHilliardModel& base, FilterProblems& data) {
  std::vector<FilterProblem::Random> random;
  for (const Candidate& candidate : candidates)
    if (candidate.random) random.push_back({candidate.name, unit_effect(base, candidate)});
  for (FilterProblem& vesicle : data) vesicle.random = random;
}

std::vector<RandomPart> random_parts(const FilterProblem& data, const Hypothesis& hypothesis,
                                     const std::vector<Candidate>& screened) {
  std::vector<RandomPart> parts;
  Eigen::Index next = kFirstParameter;
  const auto add = [&](const Candidate& candidate, double variance) {
    if (candidate.random) parts.push_back({place_of(candidate.name, data), variance, next});
    next += candidate.directions;
  };
  for (const Hypothesis::Part& part : hypothesis.parts)
    add(part.candidate, part.coefficients.front());
  for (const Candidate& candidate : screened) add(candidate, 0);
  return parts;
}

Columns noises_at_end(const FilterProblem& data, const problem::RandomEffect& effect,
                      const TangentPath& along, int most, TangentFlow& flow) {
  const Eigen::Index nodes = data.space->nodes(),
                     added = effect.noises(*data.space, along.stages.front().head(nodes)).cols();
  Columns all(nodes, 0);
  for (std::size_t step = 0; step < along.grid.steps.size(); ++step) {
    const double length = along.grid.steps[step];
    const auto stage = [&](std::size_t i) { return 2 * step + i; };
    const TangentPath alone{
        {{along.grid.stage_times[stage(0)], along.grid.stage_times[stage(1)]}, {length}},
        {along.stages[stage(0)], along.stages[stage(1)]}};
    // A Wiener process of the variance `length` rises evenly in it.
    const auto forcing = [&](double, VecView y) {
      const Columns noises = effect.noises(*data.space, y.head(nodes));
      Columns forced = Columns::Zero(2 * nodes, noises.cols());
      forced.topRows(nodes) = -noises / std::sqrt(length);
      return forced;
    };
    all = side_by_side(all, Columns::Zero(nodes, added));
    flow.advance(alone, all, forcing);
  }
  compress(data.mass, all, most);
  return all;
}

VarianceScore variance_score(const InnovationCovariance& weight, const Columns& G,
                             const Columns& values) {
  const Columns weighted = weight.solve(G);
  const Eigen::MatrixXd A = openblas::transposed_product(G, weighted);
  const Columns loads = openblas::transposed_product(weighted, values);
  return {0.5 * (loads.colwise().squaredNorm().transpose().array() - A.trace()).matrix(),
          0.5 * A.squaredNorm()};
}

// Without M Mᵀ, S₀ = S − M Mᵀ has S₀⁻¹ = S⁻¹ + S⁻¹ M (1 − A)⁻¹ Mᵀ S⁻¹ with A = Mᵀ S⁻¹ M. The gain
// is a sum over the eigenvalues λ/(1 + λ) of A: of λ x² + ln(1 − λ/(1 + λ)) with x normal.
VarianceGain variance_gain(const Innovation& innovation, const InnovationCovariance& weight) {
  VarianceGain result;
  for (const RandomValues& part : innovation.random) {
    if (part.variance == 0) continue;
    const Columns M = std::sqrt(part.variance) * part.values, weighted = weight.solve(M);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> A(
        openblas::transposed_product(M, weighted));
    const Vec share = A.eigenvalues().cwiseMax(0).cwiseMin(1 - 1e-12),
              load = A.eigenvectors().transpose() * (weighted.transpose() * innovation.values),
              ratio = (share.array() / (1 - share.array())).matrix();
    result.gain += (load.array().square() / (1 - share.array()) + (1 - share.array()).log()).sum();
    result.mean += (ratio.array() + (1 - share.array()).log()).sum();
    result.variance += 2 * ratio.squaredNorm();
  }
  return result;
}

}  // namespace traceraft::assimilation
