// Mass matrices with a weight that varies: ∫ w φ_i φ_j.
#pragma once

#include <algorithm>
#include <array>

#include "kernel/fem/surface_space.hpp"
#include "kernel/fem/triangle_rule.hpp"

namespace traceraft::fem {

namespace detail {

// λ_a λ_b times the weight at every point of the rule, for the six pairs of corners.
inline constexpr int kPairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
inline constexpr auto kPairWeights = [] {
  std::array<std::array<double, 6>, kDegreeFourRule.size()> table{};
  for (std::size_t p = 0; p < table.size(); ++p)
    for (int k = 0; k < 6; ++k)
      table[p][k] = kDegreeFourRule[p].weight * kDegreeFourRule[p].at[kPairs[k][0]] *
                    kDegreeFourRule[p].at[kPairs[k][1]];
  return table;
}();

// ∫ w λ_a λ_b between the corners of a triangle.
template <class Weight>
std::array<std::array<double, 3>, 3> weighted_triangle(double area, int triangle,
                                                       const Weight& weight) {
  std::array<double, 6> sum{};
  for (std::size_t p = 0; p < kDegreeFourRule.size(); ++p) {
    const double w = area * weight(triangle, p);
    for (int k = 0; k < 6; ++k) sum[k] += w * kPairWeights[p][k];
  }
  return {{{sum[0], sum[3], sum[5]}, {sum[3], sum[1], sum[4]}, {sum[5], sum[4], sum[2]}}};
}

template <class Weight>
Eigen::Matrix4d weighted_element(const SurfaceSpace& space, const CutElement& element,
                                 double factor, const Weight& weight) {
  Eigen::Matrix4d local = Eigen::Matrix4d::Zero();
  for (int t = 0; t < element.triangles(); ++t) {
    const int triangle = element.first_triangle + t;
    const auto mass =
        weighted_triangle(factor * space.surface.triangle_area[triangle], triangle, weight);
    std::array<int, 2> node[3];      // at the ends of the corner's edge,
    std::array<double, 2> share[3];  // and their traces at the corner
    for (int k = 0; k < 3; ++k) {
      node[k] = mesh::kTetEdges[element.cut_edge[kPolygonTriangles[t][k]]];
      const double s = space.surface.points[space.surface.triangles[triangle][k]].s;
      share[k] = {1 - s, s};
    }
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j)
            local(node[a][i], node[b][j]) += share[a][i] * mass[a][b] * share[b][j];
  }
  return local;
}

}  // namespace detail

inline std::array<double, 3> corner_values(const SurfaceSpace& space, int triangle,
                                           const Vec& point_value) {
  const auto& [i, j, k] = space.surface.triangles[triangle];
  return {point_value[i], point_value[j], point_value[k]};
}

// matrices[n] += factor · ∫ w_n φ_i φ_j with the N weights w = weights(triangle, point of
// kDegreeFourRule), which are evaluated once for all; where one is zero its matrix is not touched.
template <std::size_t N, class Weights>
void add_weighted_masses(const SurfaceSpace& space, double factor, const Weights& weights,
                         const std::array<CsrMatrix*, N>& matrices) {
  constexpr std::size_t kPoints = kDegreeFourRule.size();
  space.team->run([&](int part) {
    const RowBlock& block = space.blocks[part];
    std::array<std::array<double, std::size(kPolygonTriangles) * kPoints>, N> at;
    for (int e = block.touching_elements.begin; e < block.touching_elements.end; ++e) {
      const CutElement& element = space.elements[e];
      const std::size_t points = kPoints * static_cast<std::size_t>(element.triangles());
      for (std::size_t k = 0; k < points; ++k) {
        const std::array<double, N> w =
            weights(element.first_triangle + static_cast<int>(k / kPoints), k % kPoints);
        for (std::size_t n = 0; n < N; ++n) at[n][k] = w[n];
      }
      for (std::size_t n = 0; n < N; ++n) {
        if (std::all_of(at[n].begin(), at[n].begin() + points, [](double w) { return w == 0; }))
          continue;
        const auto weight = [&](int triangle, std::size_t p) {
          return at[n][static_cast<std::size_t>(triangle - element.first_triangle) * kPoints + p];
        };
        add_element_matrix(element, detail::weighted_element(space, element, factor, weight), block,
                           *matrices[n]);
      }
    }
  });
}

// The same for one weight, a number.
template <class Weight>
void add_weighted_mass(const SurfaceSpace& space, double factor, const Weight& weight,
                       CsrMatrix& matrix) {
  add_weighted_masses<1>(
      space, factor,
      [&](int triangle, std::size_t p) { return std::array<double, 1>{weight(triangle, p)}; },
      {&matrix});
}

}  // namespace traceraft::fem
