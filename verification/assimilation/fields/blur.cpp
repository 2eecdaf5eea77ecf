#include "verification/assimilation/fields/blur.hpp"

#include <stdexcept>

#include "verification/assimilation/fields/stiffness_along_normals.hpp"

namespace traceraft::assimilation {
namespace {

// Implicit steps that a Gaussian is made of.
constexpr int kSteps = 4;

}  // namespace

// ċ = Δ_Γ c for the time width²/2, in steps.
struct Blur::Step {
  fem::EigenMatrix mass;
  Eigen::SimplicialLLT<fem::EigenMatrix> implicit;
};

Blur::Blur(const fem::SurfaceSpace& space, double width) {
  auto step = std::make_unique<Step>();
  step->mass = fem::as_eigen(space, space.stabilised_mass);
  step->implicit.compute(
      fem::EigenMatrix(step->mass + width * width / (2 * kSteps) * stiffness_along_normals(space)));
  if (step->implicit.info() != Eigen::Success)
    throw std::runtime_error("a field cannot be blurred that much");
  step_ = std::move(step);
}

Blur::~Blur() = default;

Vec Blur::blurred(const Vec& c) const {
  Vec result = c;
  for (int k = 0; k < kSteps; ++k) result = step_->implicit.solve(step_->mass * result).eval();
  return result;
}

}  // namespace traceraft::assimilation
