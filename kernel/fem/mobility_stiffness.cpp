#include "kernel/fem/mobility_stiffness.hpp"

#include <algorithm>

namespace traceraft {
namespace {

constexpr int kBatch = 64;  // elements evaluated by one call of the mobility law

// Traces at the midpoints of the triangles' edges, three per triangle.
int midpoint_traces(const CutElement& element, const std::array<double, 4>& corner, double* out) {
  for (int t = 0; t < element.triangles(); ++t) {
    const auto& [a, b, c] = kPolygonTriangles[t];
    *out++ = 0.5 * (corner[a] + corner[b]);
    *out++ = 0.5 * (corner[b] + corner[c]);
    *out++ = 0.5 * (corner[c] + corner[a]);
  }
  return 3 * element.triangles();
}

double mean_of(const CutElement& element, const double* value) {
  double sum = element.triangle_area[0] * (value[0] + value[1] + value[2]);
  if (element.corners == 4) sum += element.triangle_area[1] * (value[3] + value[4] + value[5]);
  return sum / (3 * element.area());
}

std::array<double, 4> gradient_of(const CutElement& element, const double* slope) {
  std::array<double, 4> corner{}, nodal{};
  for (int t = 0; t < element.triangles(); ++t) {
    const auto& [a, b, c] = kPolygonTriangles[t];
    const double weight = element.triangle_area[t] / (6 * element.area());
    corner[a] += weight * (slope[3 * t] + slope[3 * t + 2]);
    corner[b] += weight * (slope[3 * t] + slope[3 * t + 1]);
    corner[c] += weight * (slope[3 * t + 1] + slope[3 * t + 2]);
  }
  element.distribute(corner, nodal);
  return nodal;
}

// Element by element in batches; gradient may be null.
void evaluate_means(const SurfaceSpace& space, const Mobility& law, ConstVec c,
                    std::vector<double>& mean, std::vector<std::array<double, 4>>* gradient) {
  mean.resize(space.elements.size());
  if (gradient) gradient->resize(space.elements.size());
  space.team->for_range(space.elements.size(), [&](std::size_t begin, std::size_t end) {
    double trace[6 * kBatch], value[6 * kBatch], slope[6 * kBatch];
    for (std::size_t first = begin; first < end; first += kBatch) {
      const std::size_t last = std::min(first + kBatch, end);
      int count = 0;
      for (std::size_t e = first; e < last; ++e)
        count += midpoint_traces(space.elements[e], space.elements[e].trace(c), trace + count);
      law.evaluate(trace, count, value, gradient ? slope : nullptr);
      int at = 0;
      for (std::size_t e = first; e < last; ++e) {
        const CutElement& element = space.elements[e];
        const double unfloored = mean_of(element, value + at);
        mean[e] = unfloored <= 0 ? 0.0 : unfloored;  // NaN stays NaN
        if (gradient)
          (*gradient)[e] =
              unfloored > 0 ? gradient_of(element, slope + at) : std::array<double, 4>{};
        at += 3 * element.triangles();
      }
    }
  });
}

}  // namespace

void mean_mobility(const SurfaceSpace& space, const Mobility& law, ConstVec c,
                   std::vector<double>& mean) {
  evaluate_means(space, law, c, mean, nullptr);
}

void mean_mobility(const SurfaceSpace& space, const Mobility& law, ConstVec c,
                   std::vector<double>& mean, std::vector<std::array<double, 4>>& gradient) {
  evaluate_means(space, law, c, mean, &gradient);
}

void assemble_mobility_stiffness(const SurfaceSpace& space, const std::vector<double>& mean,
                                 CsrMatrix& matrix) {
  std::vector<double> weight(space.mesh.edges.size());
  space.team->run([&](int part) {
    const RowBlock& block = space.blocks[part];
    for (int e = block.element_begin; e < block.element_end; ++e) {
      const CutElement& element = space.elements[e];
      for (int k = 0; k < 6; ++k) {
        const int edge = element.edge[k];
        if (edge >= block.edge_begin && edge < block.edge_end)
          weight[edge] += mean[e] * element.stiffness[k];
      }
    }
  });
  fill_zero_row_sum(weight, space.blocks, *space.team, matrix);
}

void add_mobility_flux(const SurfaceSpace& space, const std::vector<double>& mean, ConstVec u,
                       VecRef r) {
  for_each_row_contribution(
      space.elements, space.blocks, *space.team,
      [&](const CutElement& element, int e) {
        std::array<double, 4> load{};
        for (int k = 0; k < 6; ++k) {
          const auto& [i, j] = kTetEdges[k];
          const double flux =
              mean[e] * element.stiffness[k] * (u[element.node[j]] - u[element.node[i]]);
          load[i] += flux;
          load[j] -= flux;
        }
        return load;
      },
      [&](int row, double value) { r[row] += value; });
}

}  // namespace traceraft
