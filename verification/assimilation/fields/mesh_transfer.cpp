#include "verification/assimilation/fields/mesh_transfer.hpp"

#include "kernel/fem/density_load.hpp"

namespace traceraft::assimilation {

MeshTransfer::MeshTransfer(const fem::SurfaceSpace& from, bench::SpacePtr to,
                           const Eigen::Matrix3d& rotation)
    : to_(std::move(to)) {
  const mesh::CutSurface& surface = to_->surface;
  std::vector<Point> points;
  std::vector<mesh::SurfacePlace> places;
  Vec weights(static_cast<Eigen::Index>(fem::quadrature_points(surface)));
  fem::for_each_quadrature_point(surface, [&](const fem::QuadraturePoint& at) {
    weights[static_cast<Eigen::Index>(at.number)] = at.weight;
    points.push_back(rotation.transpose() * at.x);
    places.push_back({static_cast<int>(at.triangle), at.at});
  });
  load_ = trace_at(*to_, places).transpose() * weights.asDiagonal() *
          point_trace(from, points, from.h() + to_->h());
}

Vec MeshTransfer::operator()(VecView c) const {
  Vec projected(to_->nodes());
  bench::require(to_->solve_mass(load_ * c, projected));
  return projected;
}

Eigen::MatrixXd MeshTransfer::columns(const Eigen::MatrixXd& X) const {
  Eigen::MatrixXd result(to_->nodes(), X.cols());
  for (Eigen::Index k = 0; k < X.cols(); ++k) result.col(k) = (*this)(X.col(k));
  return result;
}

}  // namespace traceraft::assimilation
