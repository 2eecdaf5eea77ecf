#include "verification/measure/recovered_energy.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/spaces.hpp"

namespace traceraft {
namespace {

// ∫ |∇_Γ z|² = 8π/3 on the sphere: what is recovered is nearer to it than what is discrete, by more
// on finer meshes.
TEST(RecoveredEnergy, EstimatesTheErrorOfAnInterpolant) {
  for (const int cells : {24, 48}) {
    const auto space = testing::make_space(cells);
    Vec c(space->nodes());
    // Wavy, so that an interpolant has an error: cos(6z) extended along normals.
    for (int i = 0; i < space->nodes(); ++i)
      c[i] = std::cos(6 * space->mesh.position(i).normalized()[2]);
    // ∫ |∇_Γ cos(6z)|² = 2π ∫ 36 sin²(6z) (1 − z²) dz.
    double exact = 0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
      const double z = -1 + (k + 0.5) * 2 / kSteps;
      exact += 2 * kPi * 36 * std::pow(std::sin(6 * z), 2) * (1 - z * z) * 2 / kSteps;
    }
    const double found = space->quadratic(space->stiffness, c);
    const double corrected = found + gradient_error_squared(*space, c);
    // An interpolant has too little of the gradient, by the square of its error.
    EXPECT_LT(std::fabs(corrected / exact - 1), 0.6 * std::fabs(found / exact - 1)) << cells;
  }
}

// A boundary in equilibrium has the same energy however it lies in the mesh.
TEST(RecoveredEnergy, DoesNotDependOnTheDirection) {
  const auto space = testing::make_space(32);
  const CahnHilliard problem(space, testing::make_model("constant:value=0.25", 0.08));
  std::vector<double> plain, recovered;
  for (const Point& axis : {Point(0, 0, 1), Point(1, 2, 3)}) {
    InitialRequest request;
    request.epsilon = problem.model().epsilon;
    request.caps = {{axis, kPi / 2}};
    const Vec c = make_initial_field("caps", *space, request);
    Vec y = Vec::Zero(problem.size());
    y.head(problem.block_size()) = c;
    plain.push_back(problem.energy(y));
    recovered.push_back(recovered_energy(problem, c));
  }
  EXPECT_LT(std::fabs(recovered[1] / recovered[0] - 1), 0.5 * std::fabs(plain[1] / plain[0] - 1));
}

}  // namespace
}  // namespace traceraft
