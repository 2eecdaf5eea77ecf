// Integrals over a surface of products of harmonics, which are functions of the direction from its
// centre.
#pragma once

#include "kernel/core/types.hpp"
#include "kernel/geometry/star_surface.hpp"

namespace traceraft::flow {

// In the order of harmonic_index, symmetric.
struct HarmonicForms {
  Eigen::MatrixXd mass;              // ∫ Y_i Y_j
  Eigen::MatrixXd stiffness;         // ∫ ∇_Γ Y_i · ∇_Γ Y_j
  Eigen::MatrixXd curved_stiffness;  // ∫ K ∇_Γ Y_i · ∇_Γ Y_j, with Gauss's curvature K
};

// Up to a degree. Throws InputError where a ray does not meet the surface once.
HarmonicForms harmonic_forms(const geometry::StarSurface& surface, int degree);

}  // namespace traceraft::flow
