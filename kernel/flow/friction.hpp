// Friction of the flow of a fluid membrane: stream functions that balance forces, and those of
// thermal motion.
#pragma once

#include <memory>

#include "kernel/flow/fluid_membrane.hpp"
#include "kernel/flow/harmonic_transform.hpp"
#include "kernel/geometry/star_surface.hpp"

namespace traceraft::flow {

// Vectors have an entry per harmonic up to the degree, in the order of harmonic_index. The power
// that friction takes of the flow of a stream function ψ, in units of η_m, is ψᵀ F ψ.
class Friction {
 public:
  virtual ~Friction() = default;
  virtual int degree() const = 0;
  // F⁻¹ f. A capillary force does not turn a surface that turns into itself: its torque is an error
  // of the mesh, and is left out.
  virtual Vec capillary(const Vec& force) const = 0;
  // ψ with the covariance F⁻¹, from independent normal numbers.
  virtual Vec brownian(const Vec& normal) const = 0;
  virtual double power(const Vec& psi) const = 0;  // ψᵀ F ψ
};

// On a unit sphere the exact friction of each degree, up to `degree`. On another surface of area A
// that of the membrane is
//   ∫ (Δψ)² − 2 K |∇ψ|²,  which is ∫ 2 |E(u)|² for u = n × ∇ψ and Gauss's curvature K,
// up to the degree 32, and that of the water is W ∫ ψ √(4π/A − 4Δ) (−Δψ), which is exact on spheres
// and for short waves. Throws InputError if the surface is not like a sphere.
std::shared_ptr<const Friction> make_friction(const geometry::StarSurface& surface,
                                              const FluidMembrane& membrane, int degree);

}  // namespace traceraft::flow
