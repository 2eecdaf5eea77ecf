// Thermal noise through the steps of integrators: as much of it as fluctuation and dissipation say.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "backends/list.hpp"
#include "backends/openblas/dense_algebra.hpp"
#include "kernel/effects/effects.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::effects {
namespace {

using testing::dense;
using testing::make_model;
using testing::make_space;

constexpr double kT = 1e-8;  // so little that a phase stays where it is linear

// Integrals of c with spherical harmonics of degrees 1 and 2: what is slow.
Eigen::MatrixXd harmonics(const fem::SurfaceSpace& space) {
  const int n = space.nodes();
  Eigen::MatrixXd values(n, 8);
  for (int i = 0; i < n; ++i) {
    const Point x = space.mesh.position(i);
    values.row(i) << x[0], x[1], x[2], x[0] * x[1], x[1] * x[2], x[2] * x[0],
        x[0] * x[0] - x[1] * x[1], 3 * x[2] * x[2] - x.squaredNorm();
  }
  return openblas::product(dense(space.mass), values);
}

// Around a uniform phase M̃ ċ = −A μ + η with M̃ μ = B c, B = L Lᵀ and ⟨η ηᵀ⟩ = 2 kT K_M δ(t − t').
// In the eigenvectors of Lᵀ M̃⁻¹ A M̃⁻¹ L, with its eigenvalues λ, z = Lᵀ c has the covariance
// Q_ij/(λ_i + λ_j), Q = 2 kT Lᵀ M̃⁻¹ K_M M̃⁻¹ L.
Vec variances(const problem::CahnHilliard& base, const Vec& y, const Eigen::MatrixXd& of) {
  linear::BlockJacobian J = base.make_jacobian();
  EXPECT_TRUE(base.jacobian(0, y, Vec::Zero(y.size()), 0, linear::Tangent::exact, J).ok());
  const fem::SurfaceSpace& space = base.space();
  const Eigen::MatrixXd M = dense(J.mm), A = dense(J.cm);
  const Eigen::MatrixXd K =
      A - space.h() * base.model().mobility->scale() * dense(space.normal_stiffness);
  const openblas::SymmetricEigen B = openblas::symmetric_eigen(-dense(J.mc));
  const Vec root = B.values.cwiseSqrt();
  const Eigen::MatrixXd L = B.vectors * root.asDiagonal(), half = M.llt().solve(L);
  const auto [rate, vectors] =
      openblas::symmetric_eigen(openblas::transposed_product(half, openblas::product(A, half)));
  const Eigen::MatrixXd modes = openblas::product(half, vectors);
  Eigen::MatrixXd covariance =
      2 * kT * openblas::transposed_product(modes, openblas::product(K, modes));
  for (int i = 0; i < rate.size(); ++i)
    for (int j = 0; j < rate.size(); ++j)
      // The mean has no rate, and no noise.
      covariance(i, j) = i == 0 || j == 0 ? 0 : covariance(i, j) / (rate[i] + rate[j]);
  const Eigen::MatrixXd inverse = B.vectors * root.cwiseInverse().asDiagonal(),
                        to_z =
                            openblas::transposed_product(openblas::product(inverse, vectors), of);
  return openblas::transposed_product(to_z, openblas::product(covariance, to_z)).diagonal();
}

class ThermalNoiseTest : public ::testing::TestWithParam<const char*> {};

// Steps that its error would let grow far beyond the time between draws.
TEST_P(ThermalNoiseTest, MovesAPhaseAsMuchAsItsDissipationAllows) {
  constexpr double kBegin = 10, kEnd = 510;
  const auto space = make_space(8);
  problem::CahnHilliardModel model = make_model("constant");
  const problem::CahnHilliard base(space, model);
  add_effects("thermal:strength=1e-8,time=0.1", {1, 1, true}, model);
  const problem::CahnHilliard problem(space, model);
  EXPECT_DOUBLE_EQ(problem.longest_step(), 0.05);
  EXPECT_TRUE(std::isinf(base.longest_step()));

  const int n = problem.block_size();
  Vec y = Vec::Zero(2 * n), ydot = y;
  y.head(n).setOnes();
  const Eigen::MatrixXd slow = harmonics(*space);
  const Vec expected = variances(base, y, slow);
  ASSERT_TRUE(problem.consistent_initial_state(0, y, ydot).ok());
  time::IntegratorSettings settings;
  settings.tolerance = 1e-2;
  const time::IntegratorPtr integrator =
      backends::integrators()
          .find(GetParam())
          .make(problem, backends::choose_linear_solver("block", *space), space->team, settings);
  ASSERT_TRUE(integrator->start(0, y, ydot, kEnd).ok());
  double sum = 0, time = 0;
  while (integrator->time() < kEnd) {
    const Status status = integrator->advance();
    ASSERT_TRUE(status.ok()) << status.why;
    if (integrator->time() < kBegin) continue;
    const Vec moved = slow.transpose() * (integrator->state().head(n) - Vec::Ones(n));
    sum += integrator->step() * moved.cwiseAbs2().cwiseQuotient(expected).mean();
    time += integrator->step();
  }
  EXPECT_NEAR(sum / time, 1, 0.12);  // some 2,000 draws that do not depend on each other: 0.03
}

INSTANTIATE_TEST_SUITE_P(All, ThermalNoiseTest, ::testing::Values("euler", "ida", "rosenbrock"));

}  // namespace
}  // namespace traceraft::effects
