#include "kernel/fem/refinement_rule.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::fem {

double RefinementRule::indicator(const CutElement& element, VecView c) const {
  double square = 0;  // |∇_Γ c|² = −Σ ∇_Γλ_i·∇_Γλ_j (c_i − c_j)² over the edges
  for (std::size_t e = 0; e < 6; ++e) {
    const auto& [i, j] = mesh::kTetEdges[e];
    const double difference = c[element.node[i]] - c[element.node[j]];
    square -= element.coupling[e] * difference * difference;
  }
  return width * std::sqrt(std::max(0.0, square));
}

int RefinementRule::generation(double indicator, double threshold_now) const {
  constexpr double kRoundoff = 1e-9;
  if (!(indicator < threshold_now)) return finest_generation;
  // Three generations halve the size.
  const double coarser = 1.5 * std::log2(threshold_now / std::max(indicator, 1e-300));
  const double most = finest_generation;
  return finest_generation - static_cast<int>(std::min(most, coarser + kRoundoff));
}

std::vector<int> wanted_generations(const SurfaceSpace& space, const RefinementRule& rule,
                                    VecView c, const std::vector<int>& generation) {
  std::vector<int> wanted, at_node(static_cast<std::size_t>(space.nodes()), 0);
  wanted.reserve(space.elements.size());
  for (std::size_t t = 0; t < space.elements.size(); ++t) {
    const CutElement& element = space.elements[t];
    const double indicator = rule.indicator(element, c);
    const int least = rule.generation(indicator, rule.threshold);
    const int most = rule.generation(indicator, 0.5 * rule.threshold);
    wanted.push_back(std::clamp(generation[t], least, most));
    for (const int node : element.node) at_node[node] = std::max(at_node[node], wanted.back());
  }
  for (std::size_t t = 0; t < wanted.size(); ++t)
    for (const int node : space.elements[t].node) wanted[t] = std::max(wanted[t], at_node[node]);
  return wanted;
}

bool too_coarse(const SurfaceSpace& space, const RefinementRule& rule, VecView c,
                const std::vector<int>& generation) {
  for (std::size_t t = 0; t < space.elements.size(); ++t)
    if (generation[t] < rule.finest_generation &&
        generation[t] < rule.generation(rule.indicator(space.elements[t], c), 2 * rule.threshold))
      return true;
  return false;
}

double least_share(const std::vector<int>& wanted, const std::vector<int>& generation) {
  double sum = 0;  // two of one generation make one of the generation before
  for (std::size_t t = 0; t < wanted.size(); ++t) sum += std::exp2(wanted[t] - generation[t]);
  return sum / static_cast<double>(wanted.size());
}

}  // namespace traceraft::fem
