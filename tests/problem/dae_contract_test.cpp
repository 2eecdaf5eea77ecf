// The promises of every DAE to its integrators (kernel/problem/dae_problem.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <ostream>

#include "kernel/problem/prescribed_density.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::problem {
namespace {

using testing::make_model;
using testing::make_space;
using testing::random_state;
using testing::random_vector;

struct DaeCase {
  std::string name;
  std::string mobility;
  fem::PotentialRule rule;
  bool with_source;
};
void PrintTo(const DaeCase& dae, std::ostream* out) {
  *out << dae.name;
}

class DaeContract : public ::testing::TestWithParam<DaeCase> {
 protected:
  DaeContract() {
    CahnHilliardModel model = make_model(GetParam().mobility);
    model.rule = GetParam().rule;
    model.well = {0.3, -0.1, 1.2};
    if (GetParam().with_source)
      for (const Slot slot : {Slot::source, Slot::potential})
        model.effects.push_back(prescribed_density(
            "g", slot, [](const fem::QuadraturePoint& at, double t) { return at.x[0] + t; }));
    problem = std::make_unique<CahnHilliard>(make_space(12), model);
  }
  std::unique_ptr<CahnHilliard> problem;
};

TEST_P(DaeContract, ExactTangentIsTheDerivativeOfTheResidual) {
  const double shift = 3.7;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Vec y = random_state(*problem, seed), ydot = random_vector(problem->size(), seed + 50);
    const Vec v = random_vector(problem->size(), seed + 90);
    const auto residual_at = [&](double s) {
      Vec r(problem->size());
      EXPECT_TRUE(problem->residual(0.3, y + s * v, ydot + s * shift * v, r).ok());
      return r;
    };
    Vec product(problem->size());
    ASSERT_TRUE(
        problem->jacobian_product(0.3, y, ydot, shift, linear::Tangent::exact, v, product).ok());
    // The floor of the mobility makes F piecewise smooth: a small step crosses few kinks.
    const double step = 1e-6;
    const Vec difference = (residual_at(step) - residual_at(-step)) / (2 * step);
    EXPECT_LT((product - difference).norm(), 2e-6 * product.norm()) << "seed " << seed;
  }
}

TEST_P(DaeContract, StabilisedTangentIsTheDerivativeWithMobilityAndCurvatureFrozen) {
  // F_stab(y) = F with mobility at y* and f0'(c) replaced by f0'(c*) + β (c − c*): linear in y.
  const double shift = 0.8;
  const Vec y = random_state(*problem, 3), ydot = Vec::Zero(problem->size());
  const Vec v = random_vector(problem->size(), 4);
  linear::BlockJacobian J = problem->make_jacobian();
  ASSERT_TRUE(problem->jacobian(0.3, y, ydot, shift, linear::Tangent::stabilised, J).ok());
  const int n = problem->block_size();
  const fem::SurfaceSpace& space = problem->space();
  Vec expected = Vec::Zero(2 * n);
  // Mobility frozen: F is linear in μ, so its derivative in μ is a difference of residuals.
  Vec y_mu = y, r0(2 * n), r1(2 * n);
  y_mu.tail(n) += v.tail(n);
  ASSERT_TRUE(problem->residual(0.3, y, ydot, r0).ok());
  ASSERT_TRUE(problem->residual(0.3, y_mu, ydot, r1).ok());
  expected += r1 - r0;
  space.stabilised_mass.multiply_add(shift, v.head(n), expected.head(n), *space.team);
  const double e2 = problem->model().epsilon * problem->model().epsilon;
  space.stiffness.multiply_add(-e2, v.head(n), expected.tail(n), *space.team);
  space.normal_stiffness.multiply_add(-e2 * space.h(), v.head(n), expected.tail(n), *space.team);
  space.stabilised_mass.multiply_add(-problem->model().beta(), v.head(n), expected.tail(n),
                                     *space.team);
  Vec product(2 * n);
  J.multiply(v, product, *space.team);
  EXPECT_LT((product - expected).norm(), 1e-12 * expected.norm());
}

TEST_P(DaeContract, ProductNeedsNoMatrix) {
  const Vec y = random_state(*problem, 7), ydot = random_vector(problem->size(), 8);
  const Vec v = random_vector(problem->size(), 9);
  for (const linear::Tangent tangent : {linear::Tangent::exact, linear::Tangent::stabilised}) {
    linear::BlockJacobian J = problem->make_jacobian();
    ASSERT_TRUE(problem->jacobian(0.1, y, ydot, 1.3, tangent, J).ok());
    Vec assembled(problem->size()), direct(problem->size());
    J.multiply(v, assembled, *problem->space().team);
    ASSERT_TRUE(problem->jacobian_product(0.1, y, ydot, 1.3, tangent, v, direct).ok());
    EXPECT_LT((assembled - direct).norm(), 1e-13 * direct.norm());
  }
}

TEST_P(DaeContract, ConsistentStateSolvesTheEquations) {
  Vec y = Vec::Zero(problem->size()), ydot(problem->size()), r(problem->size());
  y.head(problem->block_size()) = random_vector(problem->block_size(), 11, 0, 1);
  ASSERT_TRUE(problem->consistent_initial_state(0.2, y, ydot).ok());
  ASSERT_TRUE(problem->residual(0.2, y, ydot, r).ok());
  Vec flux(problem->size());  // what the terms of F1 amount to before they cancel
  ASSERT_TRUE(problem->residual(0.2, y, Vec::Zero(problem->size()), flux).ok());
  EXPECT_LT(r.norm(), 1e-11 * flux.norm());
}

TEST_P(DaeContract, ResidualKeepsMassForAnyStateExactlyIfTheModelSaysSo) {
  EXPECT_EQ(problem->conserves_mass(), !GetParam().with_source);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Vec y = random_state(*problem, seed);
    Vec r(problem->size());
    ASSERT_TRUE(problem->residual(0.3, y, Vec::Zero(problem->size()), r).ok());
    const auto first = r.head(problem->block_size());
    const bool kept = std::fabs(first.sum()) < 1e-14 * first.cwiseAbs().sum();
    EXPECT_EQ(kept, problem->conserves_mass());
  }
}

TEST_P(DaeContract, DissipatesEnergyForAnyStateExactlyIfTheModelSaysSo) {
  // dE/dt = −μᵀ (K_M + ρS) μ ≤ 0 along ċ from a consistent state, if b is the gradient of an
  // energy.
  const int n = problem->block_size();
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Vec y = random_state(*problem, seed), ydot(problem->size());
    ASSERT_TRUE(problem->consistent_initial_state(0, y, ydot).ok());
    Vec flux(2 * n);
    ASSERT_TRUE(problem->residual(0, y, Vec::Zero(2 * n), flux).ok());
    const double dissipation = y.tail(n).dot(flux.head(n));
    const double step = 1e-7 * y.head(n).norm() / ydot.head(n).norm();
    const Vec forth = y + step * ydot, back = y - step * ydot;
    const double rate = (problem->energy(forth) - problem->energy(back)) / (2 * step);
    if (problem->dissipates_energy()) {
      EXPECT_GE(dissipation, 0);
    }
    worst = std::max(worst, std::fabs(rate / dissipation + 1));
  }
  EXPECT_EQ(worst < 1e-3, problem->dissipates_energy()) << worst;
}

TEST_P(DaeContract, SaysSoWhenTheStateIsNotFinite) {
  Vec y = random_state(*problem, 1), r(problem->size());
  const Vec ydot = Vec::Zero(problem->size());
  for (const double poison : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    y[problem->block_size() / 2] = poison;
    EXPECT_EQ(problem->residual(0, y, ydot, r).outcome, Outcome::retry);
    linear::BlockJacobian J = problem->make_jacobian();
    EXPECT_EQ(problem->jacobian(0, y, ydot, 1, linear::Tangent::stabilised, J).outcome,
              Outcome::retry);
    EXPECT_EQ(problem->jacobian(0, y, ydot, 1, linear::Tangent::exact, J).outcome, Outcome::retry);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, DaeContract,
    ::testing::Values(
        DaeCase{"averaged", "degenerate", fem::PotentialRule::averaged, false},
        DaeCase{"degenerate", "degenerate", fem::PotentialRule::consistent, false},
        DaeCase{"floored", "degenerate:outside=-1", fem::PotentialRule::consistent, false},
        DaeCase{"constant", "constant:value=0.3", fem::PotentialRule::consistent, false},
        DaeCase{"nodal", "degenerate", fem::PotentialRule::nodal, false},
        DaeCase{"sources", "degenerate", fem::PotentialRule::consistent, true}),
    [](const auto& info) { return info.param.name; });

TEST(Norm, DoesNotSeeTheMesh) {
  double norms[2];
  int i = 0;
  for (const int cells : {16, 32}) {
    const CahnHilliard problem(make_space(cells), make_model());
    norms[i++] = problem.norm(Vec::Ones(problem.size()));
  }
  EXPECT_NEAR(norms[0], std::sqrt(4 * M_PI), 0.03);
  EXPECT_NEAR(norms[1] / norms[0], 1, 0.01);
}

TEST(DaeInvariants, HoldOnAHundredPositionsOfTheSurface) {
  for (int i = 0; i < 100; ++i) {
    const Point offset = 0.2 * Point(uniform_random(3, 0, i) - 0.5, uniform_random(3, 1, i) - 0.5,
                                     uniform_random(3, 2, i) - 0.5);
    const CahnHilliard problem(make_space(10, "sphere", 1, offset), make_model());
    const testing::StartState start = testing::noise_state(problem, i + 1, 0.3);
    EXPECT_NEAR(problem.mass(start.y) / problem.space().area, 0.3, 1e-13);
    EXPECT_LT(std::fabs(problem.mass(start.ydot)), 1e-12 * start.ydot.norm());
  }
}

}  // namespace
}  // namespace traceraft::problem
