#include "kernel/flow/transport.hpp"

namespace traceraft::flow {
namespace {

// ∫_T n·(∇ψ × ∇λ_i) of the four basis functions.
std::array<double, 4> carried_by(const fem::CutElement& element, const ElementCurl& curl,
                                 VecView psi) {
  std::array<double, 4> flux{};
  for (std::size_t e = 0; e < curl.size(); ++e) {
    const auto& [i, j] = mesh::kTetEdges[e];
    flux[j] += psi[element.node[i]] * curl[e];
    flux[i] -= psi[element.node[j]] * curl[e];
  }
  return flux;
}

// The area of an element on Γ_h times its normal, which is none where the area is 0.
Point area_vector(const fem::SurfaceSpace& space, std::size_t e) {
  const Point normal = mesh::cut_normal(space.mesh, space.mesh.tets[e]);
  Point sum = Point::Zero();
  for (int t = 0; t < space.elements[e].triangles(); ++t) {
    const auto& [i, j, k] =
        space.surface.triangles[static_cast<std::size_t>(space.elements[e].first_triangle + t)];
    const std::vector<Point>& x = space.surface.position;
    const Point area = 0.5 * (x[j] - x[i]).cross(x[k] - x[i]);
    sum += area.dot(normal) < 0 ? Point(-area) : area;
  }
  return sum;
}

}  // namespace

std::vector<ElementCurl> element_curls(const fem::SurfaceSpace& space) {
  std::vector<ElementCurl> curls(space.elements.size());
  for (std::size_t e = 0; e < curls.size(); ++e) {
    const mesh::ActiveTet& tet = space.mesh.tets[e];
    const auto& gradient = space.mesh.shape(tet).gradients;
    const Point area = area_vector(space, e) / (space.h() * space.h());
    for (std::size_t k = 0; k < curls[e].size(); ++k) {
      const auto& [i, j] = mesh::kTetEdges[k];
      const Point a = gradient.row(i), b = gradient.row(j);
      curls[e][k] = area.dot(a.cross(b));
    }
  }
  return curls;
}

void add_transport(const fem::SurfaceSpace& space, const std::vector<ElementCurl>& curls,
                   double factor, VecView c, VecView psi, VecRef r) {
  space.team->run([&](int part) {
    const fem::RowBlock& block = space.blocks[static_cast<std::size_t>(part)];
    for (int e = block.touching_elements.begin; e < block.touching_elements.end; ++e) {
      const fem::CutElement& element = space.elements[static_cast<std::size_t>(e)];
      const std::array<double, 4>& weight = space.moments[static_cast<std::size_t>(e)].mean;
      double mean = 0;
      for (std::size_t i = 0; i < 4; ++i) mean += weight[i] * c[element.node[i]];
      const auto flux = carried_by(element, curls[static_cast<std::size_t>(e)], psi);
      for (std::size_t i = 0; i < 4; ++i)
        if (const int row = element.node[i]; block.rows.contains(row))
          r[row] += factor * mean * flux[i];
    }
  });
}

void add_transport_matrix(const fem::SurfaceSpace& space, const std::vector<ElementCurl>& curls,
                          double factor, VecView psi, fem::CsrMatrix& matrix) {
  fem::add_element_matrices(
      space,
      [&](const fem::CutElement& element, int e) -> Eigen::Matrix4d {
        const auto k = static_cast<std::size_t>(e);
        const auto flux = carried_by(element, curls[k], psi);
        return factor * Eigen::Map<const Eigen::Vector4d>(flux.data()) *
               Eigen::Map<const Eigen::RowVector4d>(space.moments[k].mean.data());
      },
      matrix);
}

}  // namespace traceraft::flow
