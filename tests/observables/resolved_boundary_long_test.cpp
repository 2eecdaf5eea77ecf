#include <gtest/gtest.h>

#include "kernel/observables/resolved_boundary.hpp"
#include "tests/support/relaxed_boundary.hpp"

namespace traceraft::observables {
namespace {

using testing::make_space;

// ∫ ε|∇c|² of two halves in equilibrium over that of a straight boundary of the same length.
double measured_resolution(const problem::CahnHilliardModel& model, const fem::SurfaceSpace& space,
                           int axes) {
  double sum = 0;
  for (int k = 0; k < axes; ++k) {
    const Vec c =
        testing::relaxed_boundary(space, model, testing::random_direction(8, std::uint64_t(k)));
    sum += model.epsilon * space.quadratic(space.stiffness, c) / (2 * kPi);
  }
  return sum / axes / model.well.interface_energy();
}

TEST(ResolvedBoundary, IsWhatBoundariesHaveOnAverage) {
  constexpr int kAxes = 16;
  const auto space = make_space(48);
  for (const double h_over_epsilon : {1.3, 2.6, 4.5})
    for (const auto& [rule, scatter] : {std::pair(fem::PotentialRule::averaged, 0.0013),
                                        std::pair(fem::PotentialRule::consistent, 0.0035),
                                        std::pair(fem::PotentialRule::nodal, 0.011)}) {
      problem::CahnHilliardModel model =
          testing::make_model("degenerate", space->h() / h_over_epsilon);
      model.rule = rule;
      const double straight = 1 - 4 * model.epsilon * model.epsilon;
      EXPECT_NEAR(measured_resolution(model, *space, kAxes) / straight,
                  resolved_boundary(model, space->h()).resolved,
                  3 * scatter * h_over_epsilon / std::sqrt(kAxes))
          << h_over_epsilon << " " << scatter;
    }
}

}  // namespace
}  // namespace traceraft::observables
