// Fields from one mesh of a surface to another.
#pragma once

#include "verification/assimilation/fields/point_trace.hpp"
#include "verification/bench/bench.hpp"

namespace traceraft::assimilation {

// L² projection: ∫ c φ over the surface of the new mesh for all of its φ, c being taken at the
// points of a quadrature of degree 4. Interpolated at the nodes instead, which lie off the surface,
// the raft fraction changes by 6.5e-4 with each transfer (24 cells), as much as by an effect.
class MeshTransfer {
 public:
  MeshTransfer() = default;
  // Serial spaces of one surface. Throws InputError if they are not near each other.
  // `rotation`: that the field is turned by.
  MeshTransfer(const fem::SurfaceSpace& from, bench::SpacePtr to,
               const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity());

  Vec operator()(VecView c) const;  // nodal values on `from` to those on `to`
  Eigen::MatrixXd columns(const Eigen::MatrixXd& X) const;

 private:
  bench::SpacePtr to_;
  PointTrace load_;  // a row per node of `to`, a column per node of `from`
};

}  // namespace traceraft::assimilation
