#include "kernel/effects/advection.hpp"

#include "kernel/fem/trace.hpp"
#include "kernel/fem/triangle_rule.hpp"
#include "kernel/fem/weighted_mass.hpp"

namespace traceraft::effects {
namespace {

class Advection final : public problem::Effect {
 public:
  Advection(std::string name, Velocity velocity,
            std::function<void(const fem::SurfaceSpace&)> require_surface)
      : name_(std::move(name)),
        velocity_(std::move(velocity)),
        require_surface_(std::move(require_surface)) {}

  std::string name() const override { return name_; }
  bool conserves_mass() const override { return true; }
  bool dissipates_energy() const override { return false; }
  void require_surface(const fem::SurfaceSpace& space) const override {
    if (require_surface_) require_surface_(space);
  }

  void add_residual(const fem::SurfaceSpace& space, double t, VecView c, VecView, VecRef residual_c,
                    VecRef) const override {
    fem::CsrMatrix matrix(space.pattern);
    add_matrix(space, t, matrix);
    matrix.multiply_add(1, c, residual_c, *space.team);
  }
  void add_tangent(const fem::SurfaceSpace& space, double t, VecView, VecView,
                   linear::BlockJacobian& J) const override {
    add_matrix(space, t, J.cc);
  }
  void add_tangent_product(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                           VecView direction_c, VecView, VecRef product_c,
                           VecRef product_mu) const override {
    (void)c;
    add_residual(space, t, direction_c, mu, product_c, product_mu);
  }

 private:
  // A_ij = −∫ φ_j u·∇_Γφ_i.
  void add_matrix(const fem::SurfaceSpace& space, double t, fem::CsrMatrix& matrix) const {
    fem::add_element_matrices(
        space,
        [&](const fem::CutElement& element, int e) { return element_matrix(space, element, e, t); },
        matrix);
  }

  Eigen::Matrix4d element_matrix(const fem::SurfaceSpace& space, const fem::CutElement& element,
                                 int e, double t) const {
    const mesh::ActiveTet& tet = space.mesh.tets[e];
    const Point normal = mesh::cut_normal(space.mesh, tet);
    const auto& gradient = space.mesh.shape(tet).gradients;
    // The weighted traces, ∫ φ_j u.
    Eigen::Matrix<double, 4, 3> carried = Eigen::Matrix<double, 4, 3>::Zero();
    for (int k = 0; k < element.triangles(); ++k) {
      const auto triangle = static_cast<std::size_t>(element.first_triangle + k);
      for (const auto& [at, weight] : fem::kDegreeFourRule) {
        Point x = Point::Zero();
        Eigen::Vector4d basis = Eigen::Vector4d::Zero();
        for (int corner = 0; corner < 3; ++corner) {
          const int point = space.surface.triangles[triangle][corner];
          x += at[corner] * space.surface.position[point];
          const auto& ends = mesh::kTetEdges[element.cut_edge[fem::kPolygonTriangles[k][corner]]];
          const double s = space.surface.points[point].s;
          basis[ends[0]] += at[corner] * (1 - s);
          basis[ends[1]] += at[corner] * s;
        }
        const Point u = velocity_(x, t);
        carried += weight * space.surface.triangle_area[triangle] * basis *
                   (u - u.dot(normal) * normal).transpose();
      }
    }
    return -gradient / space.h() * carried.transpose();
  }

  std::string name_;
  Velocity velocity_;
  std::function<void(const fem::SurfaceSpace&)> require_surface_;
};

}  // namespace

problem::EffectPtr advection(std::string name, Velocity velocity,
                             std::function<void(const fem::SurfaceSpace&)> require_surface) {
  return std::make_shared<Advection>(std::move(name), std::move(velocity),
                                     std::move(require_surface));
}

}  // namespace traceraft::effects
