#include "kernel/fem/mobility_stiffness.hpp"

#include <algorithm>

#include "kernel/fem/trace.hpp"

namespace traceraft::fem {
namespace {

// G_T μ_T: the flux through the nodes of an element whose mobility integrates to one.
std::array<double, 4> unit_flux(const CutElement& element, VecView mu) {
  std::array<double, 4> flux{};
  for (int k = 0; k < 6; ++k) {
    const auto& [i, j] = mesh::kTetEdges[k];
    const double along = element.coupling[k] * (mu[element.node[j]] - mu[element.node[i]]);
    flux[i] += along;
    flux[j] -= along;
  }
  return flux;
}

constexpr int kBatch = 64;  // triangles evaluated by one call of the mobility law

// Adds the derivative of one triangle's integral, given M' at the midpoints of its edges.
void add_gradient(const SurfaceSpace& space, int triangle, const double* slope,
                  std::array<double, 4>& gradient) {
  const mesh::CutSurface& surface = space.surface;
  const CutElement& element = space.elements[surface.triangle_tet[triangle]];
  const double weight = surface.triangle_area[triangle] / 6;
  const double at_corner[3] = {weight * (slope[0] + slope[2]), weight * (slope[0] + slope[1]),
                               weight * (slope[1] + slope[2])};
  for (int k = 0; k < 3; ++k) {
    const int corner = kPolygonTriangles[triangle - element.first_triangle][k];
    const auto& [low, high] = mesh::kTetEdges[element.cut_edge[corner]];
    const double s = surface.points[surface.triangles[triangle][k]].s;
    gradient[low] += (1 - s) * at_corner[k];
    gradient[high] += s * at_corner[k];
  }
}

// The integrals over triangles [begin, end), added to their elements; gradient may be null.
void add_integrals(const SurfaceSpace& space, const physics::Mobility& law, const Vec& point_value,
                   int begin, int end, std::vector<double>& integral,
                   std::vector<std::array<double, 4>>* gradient) {
  const mesh::CutSurface& surface = space.surface;
  double midpoint[3 * kBatch], value[3 * kBatch], slope[3 * kBatch];
  for (int first = begin; first < end; first += kBatch) {
    const int count = std::min(kBatch, end - first);
    for (int t = 0; t < count; ++t) {
      const auto& [i, j, k] = surface.triangles[first + t];
      const double a = point_value[i], b = point_value[j], c = point_value[k];
      midpoint[3 * t] = 0.5 * (a + b);
      midpoint[3 * t + 1] = 0.5 * (b + c);
      midpoint[3 * t + 2] = 0.5 * (c + a);
    }
    law.evaluate(midpoint, 3 * count, value, gradient ? slope : nullptr);
    for (int t = 0; t < count; ++t) {
      const int element = surface.triangle_tet[first + t];
      integral[element] += surface.triangle_area[first + t] / 3 *
                           (value[3 * t] + value[3 * t + 1] + value[3 * t + 2]);
      if (gradient) add_gradient(space, first + t, slope + 3 * t, (*gradient)[element]);
    }
  }
}

std::vector<double> evaluate_integrals(const SurfaceSpace& space, const physics::Mobility& law,
                                       VecView c, std::vector<std::array<double, 4>>* gradient) {
  const std::size_t elements = space.elements.size();
  const Vec point_value = trace(space, c);
  std::vector<double> integral(elements, 0.0);
  if (gradient) gradient->assign(elements, {});
  space.team->for_range(elements, [&](std::size_t begin, std::size_t end) {
    if (begin == end) return;
    const int last = end < elements ? space.elements[end].first_triangle
                                    : static_cast<int>(space.surface.triangles.size());
    add_integrals(space, law, point_value, space.elements[begin].first_triangle, last, integral,
                  gradient);
    for (std::size_t e = begin; e < end; ++e) {
      if (!(integral[e] <= 0)) continue;  // NaN stays NaN
      integral[e] = 0;
      if (gradient) (*gradient)[e] = {};
    }
  });
  return integral;
}

// Entries of Σ_T I_T G_T off the diagonal, per active edge.
std::vector<double> edge_weights(const SurfaceSpace& space, const std::vector<double>& integral) {
  const EdgeCouplings& couplings = space.edge_couplings;
  std::vector<double> weight(space.mesh.edges.size());
  space.team->for_range(weight.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      double sum = 0;
      for (int k = couplings.begin[e]; k < couplings.begin[e + 1]; ++k)
        sum += couplings.coupling[k] * integral[couplings.element[k]];
      weight[e] = sum;
    }
  });
  return weight;
}

}  // namespace

std::vector<double> mobility_integrals(const SurfaceSpace& space, const physics::Mobility& law,
                                       VecView c) {
  return evaluate_integrals(space, law, c, nullptr);
}

std::vector<double> mobility_integrals(const SurfaceSpace& space, const physics::Mobility& law,
                                       VecView c, std::vector<std::array<double, 4>>& gradient) {
  return evaluate_integrals(space, law, c, &gradient);
}

void assemble_mobility_stiffness(const SurfaceSpace& space, const std::vector<double>& integral,
                                 CsrMatrix& matrix) {
  fill_zero_row_sum(edge_weights(space, integral), space.blocks, *space.team, matrix);
}

void add_mobility_flux(const SurfaceSpace& space, const std::vector<double>& integral, VecView u,
                       VecRef r) {
  const SparsityPattern& pattern = *space.pattern;
  const std::vector<double> weight = edge_weights(space, integral);
  space.team->for_range(pattern.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double flux = 0;
      for (int k = pattern.row_begin[i]; k < pattern.row_begin[i + 1]; ++k)
        if (const int e = pattern.edge_of_entry[k]; e >= 0)
          flux += weight[e] * (u[pattern.column[k]] - u[i]);
      r[i] += flux;
    }
  });
}

std::vector<double> mobility_change(const SurfaceSpace& space,
                                    const std::vector<std::array<double, 4>>& gradient,
                                    VecView direction) {
  std::vector<double> change(gradient.size(), 0);
  space.team->for_range(change.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      for (int i = 0; i < 4; ++i)
        change[e] += gradient[e][i] * direction[space.elements[e].node[i]];
  });
  return change;
}

void add_mobility_derivative(const SurfaceSpace& space, double factor, VecView mu,
                             const std::vector<std::array<double, 4>>& gradient,
                             CsrMatrix& matrix) {
  add_element_matrices(
      space,
      [&](const CutElement& element, int e) -> Eigen::Matrix4d {
        const std::array<double, 4> flux = unit_flux(element, mu);
        return factor * Eigen::Map<const Eigen::Vector4d>(flux.data()) *
               Eigen::Map<const Eigen::RowVector4d>(gradient[e].data());
      },
      matrix);
}

}  // namespace traceraft::fem
