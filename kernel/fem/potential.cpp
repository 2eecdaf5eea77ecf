#include "kernel/fem/potential.hpp"

#include <algorithm>
#include <array>

#include "kernel/fem/triangle_rule.hpp"

namespace traceraft {
namespace {

// Calls use(corner indices, value at the point, barycentrics, area weight) for every quadrature
// point of an element.
template <class Use>
void for_each_point(const CutElement& element, const std::array<double, 4>& corner,
                    const Use& use) {
  for (int t = 0; t < element.triangles(); ++t) {
    const auto& v = kPolygonTriangles[t];
    for (const auto& [at, weight] : kDegreeFourRule)
      use(v, at[0] * corner[v[0]] + at[1] * corner[v[1]] + at[2] * corner[v[2]], at,
          weight * element.triangle_area[t]);
  }
}

std::array<double, 4> local_potential(const CutElement& element, const DoubleWell& well,
                                      double factor, ConstVec c) {
  std::array<double, 4> load{}, nodal{};
  for_each_point(element, element.trace(c),
                 [&](const auto& v, double value, const auto& at, double w) {
                   const double density = factor * w * well.derivative(value);
                   for (int k = 0; k < 3; ++k) load[v[k]] += density * at[k];
                 });
  element.distribute(load, nodal);
  return nodal;
}

// ∫ f0''(c_h) λ_a λ_b between the polygon's vertices.
Eigen::Matrix4d polygon_tangent(const CutElement& element, const DoubleWell& well, ConstVec c) {
  Eigen::Matrix4d tangent = Eigen::Matrix4d::Zero();
  for_each_point(element, element.trace(c),
                 [&](const auto& v, double value, const auto& at, double w) {
                   const double density = w * well.second(value);
                   for (int a = 0; a < 3; ++a)
                     for (int b = 0; b < 3; ++b) tangent(v[a], v[b]) += density * at[a] * at[b];
                 });
  return tangent;
}

Eigen::Matrix4d local_tangent(const CutElement& element, const DoubleWell& well, ConstVec c) {
  const Eigen::Matrix4d polygon = polygon_tangent(element, well, c);
  Eigen::Matrix4d local = Eigen::Matrix4d::Zero();
  for (int a = 0; a < element.corners; ++a)
    for (int b = 0; b < element.corners; ++b) {
      const auto& p = kTetEdges[element.cut_edge[a]];
      const auto& q = kTetEdges[element.cut_edge[b]];
      const double pa[2] = {1 - element.s[a], element.s[a]};
      const double qb[2] = {1 - element.s[b], element.s[b]};
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) local(p[i], q[j]) += pa[i] * polygon(a, b) * qb[j];
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
  for_each_row_contribution(
      space.elements, space.blocks, *space.team,
      [&](const CutElement& element, int) { return local_potential(element, well, factor, c); },
      [&](int row, double value) { r[row] += value; });
}

void add_potential_tangent(const SurfaceSpace& space, const DoubleWell& well, PotentialRule rule,
                           double factor, ConstVec c, CsrMatrix& matrix) {
  if (rule == PotentialRule::nodal) return add_nodal_tangent(space, well, factor, c, matrix);
  add_element_matrices(
      space,
      [&](const CutElement& element, int) -> Eigen::Matrix4d {
        return factor * local_tangent(element, well, c);
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
  for_each_row_contribution(
      space.elements, space.blocks, *space.team,
      [&](const CutElement& element, int) {
        const std::array<double, 4> direction = element.trace(v);
        std::array<double, 4> load{}, nodal{};
        for_each_point(element, element.trace(c),
                       [&](const auto& p, double value, const auto& at, double w) {
                         double along = 0;
                         for (int k = 0; k < 3; ++k) along += at[k] * direction[p[k]];
                         const double density = factor * w * well.second(value) * along;
                         for (int k = 0; k < 3; ++k) load[p[k]] += density * at[k];
                       });
        element.distribute(load, nodal);
        return nodal;
      },
      [&](int row, double value) { r[row] += value; });
}

double potential_energy(const SurfaceSpace& space, const DoubleWell& well, ConstVec c) {
  // Summed in chunks of fixed size so that the result does not depend on the number of threads.
  constexpr std::size_t kChunk = 1024;
  std::vector<double> partial((space.elements.size() + kChunk - 1) / kChunk, 0.0);
  space.team->for_range(partial.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      const std::size_t last = std::min((chunk + 1) * kChunk, space.elements.size());
      for (std::size_t e = chunk * kChunk; e < last; ++e)
        for_each_point(space.elements[e], space.elements[e].trace(c),
                       [&](const auto&, double value, const auto&, double w) {
                         partial[chunk] += w * well.energy(value);
                       });
    }
  });
  double total = 0;
  for (const double part : partial) total += part;
  return total;
}

}  // namespace traceraft
