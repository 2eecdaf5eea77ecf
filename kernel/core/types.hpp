// The vector types every interface uses, and π.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace traceraft {

using Point = Eigen::Vector3d;                 // coordinates in units of the surface scale R
using Vec = Eigen::VectorXd;                   // owned, contiguous
using VecRef = Eigen::Ref<Eigen::VectorXd>;    // written in place
using VecView = const Eigen::Ref<const Vec>&;  // read only, no copy of contiguous data

constexpr double kPi = 3.14159265358979323846;

}  // namespace traceraft
