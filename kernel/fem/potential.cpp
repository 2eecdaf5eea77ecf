#include "kernel/fem/potential.hpp"

#include <algorithm>
#include <array>

#include "kernel/fem/trace.hpp"
#include "kernel/fem/triangle_rule.hpp"

namespace traceraft {
namespace {

// Calls use(value at the point, barycentrics, area weight) for every quadrature point of a triangle
// whose corners have the traces given.
template <class Use>
void for_each_point(double area, const std::array<double, 3>& corner, const Use& use) {
  for (const auto& [at, weight] : kDegreeFourRule)
    use(at[0] * corner[0] + at[1] * corner[1] + at[2] * corner[2], at, weight * area);
}

std::array<double, 3> corners_of(const SurfaceSpace& space, int triangle, const Vec& point_value) {
  const auto& [i, j, k] = space.surface.triangles[triangle];
  return {point_value[i], point_value[j], point_value[k]};
}

// λ_a λ_b times the weight at every point of the rule, for the six pairs of corners.
constexpr int kPairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
constexpr auto kPairWeights = [] {
  std::array<std::array<double, 6>, kDegreeFourRule.size()> table{};
  for (std::size_t p = 0; p < table.size(); ++p)
    for (int k = 0; k < 6; ++k)
      table[p][k] = kDegreeFourRule[p].weight * kDegreeFourRule[p].at[kPairs[k][0]] *
                    kDegreeFourRule[p].at[kPairs[k][1]];
  return table;
}();

// ∫ f0''(c_h) λ_a λ_b between the corners of a triangle.
std::array<std::array<double, 3>, 3> triangle_tangent(double area,
                                                      const std::array<double, 3>& corner,
                                                      const DoubleWell& well) {
  std::array<double, 6> sum{};
  for (std::size_t p = 0; p < kDegreeFourRule.size(); ++p) {
    const auto& at = kDegreeFourRule[p].at;
    const double second =
        area * well.second(at[0] * corner[0] + at[1] * corner[1] + at[2] * corner[2]);
    for (int k = 0; k < 6; ++k) sum[k] += second * kPairWeights[p][k];
  }
  return {{{sum[0], sum[3], sum[5]}, {sum[3], sum[1], sum[4]}, {sum[5], sum[4], sum[2]}}};
}

// ∫ f0''(c_h) φ_i φ_j over one element, times a factor.
Eigen::Matrix4d local_tangent(const SurfaceSpace& space, const CutElement& element,
                              const DoubleWell& well, double factor, const Vec& point_value) {
  Eigen::Matrix4d local = Eigen::Matrix4d::Zero();
  for (int t = 0; t < element.triangles(); ++t) {
    const int triangle = element.first_triangle + t;
    const auto tangent = triangle_tangent(factor * space.surface.triangle_area[triangle],
                                          corners_of(space, triangle, point_value), well);
    std::array<int, 2> node[3];       // at the ends of the corner's edge,
    std::array<double, 2> weight[3];  // and their traces at the corner
    for (int k = 0; k < 3; ++k) {
      node[k] = kTetEdges[element.cut_edge[kPolygonTriangles[t][k]]];
      const double s = space.surface.points[space.surface.triangles[triangle][k]].s;
      weight[k] = {1 - s, s};
    }
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j)
            local(node[a][i], node[b][j]) += weight[a][i] * tangent[a][b] * weight[b][j];
  }
  return local;
}

void add_nodal_tangent(const SurfaceSpace& space, const DoubleWell& well, double factor, ConstVec c,
                       CsrMatrix& matrix) {
  for (std::size_t k = 0; k < matrix.values.size(); ++k)
    matrix.values[k] += factor * space.mass.values[k] * well.second(c[matrix.pattern->column[k]]);
}

}  // namespace

void add_potential(const SurfaceSpace& space, const DoubleWell& well, PotentialRule rule,
                   double factor, ConstVec c, VecRef r) {
  if (rule == PotentialRule::nodal) {
    const Vec derivative = c.unaryExpr([&](double value) { return well.derivative(value); });
    space.mass.multiply_add(factor, derivative, r, *space.team);
    return;
  }
  const Vec point_value = trace(space, c);
  const Vec load = point_loads(space, [&](int triangle) {
    std::array<double, 3> corner_load{};
    for_each_point(space.surface.triangle_area[triangle], corners_of(space, triangle, point_value),
                   [&](double value, const auto& at, double w) {
                     const double density = w * well.derivative(value);
                     for (int k = 0; k < 3; ++k) corner_load[k] += density * at[k];
                   });
    return corner_load;
  });
  add_trace_transpose(space, factor, load, r);
}

void add_potential_tangent(const SurfaceSpace& space, const DoubleWell& well, PotentialRule rule,
                           double factor, ConstVec c, CsrMatrix& matrix) {
  if (rule == PotentialRule::nodal) return add_nodal_tangent(space, well, factor, c, matrix);
  const Vec point_value = trace(space, c);
  add_element_matrices(
      space,
      [&](const CutElement& element, int) -> Eigen::Matrix4d {
        return local_tangent(space, element, well, factor, point_value);
      },
      matrix);
}

void add_potential_tangent_product(const SurfaceSpace& space, const DoubleWell& well,
                                   PotentialRule rule, double factor, ConstVec c, ConstVec v,
                                   VecRef r) {
  if (rule == PotentialRule::nodal) {
    const Vec scaled = c.binaryExpr(
        v, [&](double value, double direction) { return well.second(value) * direction; });
    space.mass.multiply_add(factor, scaled, r, *space.team);
    return;
  }
  const Vec point_value = trace(space, c), point_direction = trace(space, v);
  const Vec load = point_loads(space, [&](int triangle) {
    const std::array<double, 3> direction = corners_of(space, triangle, point_direction);
    std::array<double, 3> corner_load{};
    for_each_point(space.surface.triangle_area[triangle], corners_of(space, triangle, point_value),
                   [&](double value, const auto& at, double w) {
                     const double along =
                         at[0] * direction[0] + at[1] * direction[1] + at[2] * direction[2];
                     const double density = w * well.second(value) * along;
                     for (int k = 0; k < 3; ++k) corner_load[k] += density * at[k];
                   });
    return corner_load;
  });
  add_trace_transpose(space, factor, load, r);
}

double potential_energy(const SurfaceSpace& space, const DoubleWell& well, ConstVec c) {
  // Summed in chunks of fixed size so that the result does not depend on the number of threads.
  constexpr std::size_t kChunk = 1024;
  const Vec point_value = trace(space, c);
  const std::vector<double>& area = space.surface.triangle_area;
  const bool alone = space.communicator->size() == 1;
  std::vector<double> partial((area.size() + kChunk - 1) / kChunk, 0.0);
  space.team->for_range(partial.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      const std::size_t last = std::min((chunk + 1) * kChunk, area.size());
      for (std::size_t t = chunk * kChunk; t < last; ++t)
        if (alone || space.owns_triangle(t))
          for_each_point(area[t], corners_of(space, static_cast<int>(t), point_value),
                         [&](double value, const auto&, double w) {
                           partial[chunk] += w * well.energy(value);
                         });
    }
  });
  double total = 0;
  for (const double part : partial) total += part;
  return total;
}

}  // namespace traceraft
