#include <gtest/gtest.h>

#include "backends/openblas/dense_algebra.hpp"
#include "kernel/fem/mobility_stiffness.hpp"
#include "kernel/fem/potential.hpp"
#include "kernel/fem/trace.hpp"
#include "kernel/fem/triangle_rule.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::fem {
namespace {

using testing::dense;
using testing::make_space;
using testing::random_vector;

// ∫_Γ f(x, c_h, ∇c_h) by brute force over the images of the triangles of Γ_h, with (∇c_h)² by their
// metric: slow and easy to check by hand.
template <class F>
double integrate(const SurfaceSpace& space, const std::vector<mesh::LiftedTriangle>& lifted,
                 const Vec& c, const F& f) {
  const Vec trace = fem::trace(space, c);
  double sum = 0;
  for (std::size_t k = 0; k < lifted.size(); ++k) {
    const auto& [i, j, l] = space.surface.triangles[k];
    const mesh::ActiveTet& tet = space.mesh.tets[space.surface.triangle_tet[k]];
    Point gradient = Point::Zero();
    for (int v = 0; v < 4; ++v)
      gradient += c[tet.node[v]] / space.h() * space.mesh.shape(tet).gradients.row(v).transpose();
    const double squared_slope = gradient.dot(lifted[k].inverse_metric * gradient);
    for (const auto& [at, weight] : kDegreeFourRule)
      sum += weight * lifted[k].area *
             f(at[0] * trace[i] + at[1] * trace[j] + at[2] * trace[l], squared_slope);
  }
  return sum;
}

class OperatorTest : public ::testing::TestWithParam<std::string> {
 protected:
  std::shared_ptr<const SurfaceSpace> space =
      make_space(GetParam() == "sphere" ? 12 : 24, GetParam());
  std::vector<mesh::LiftedTriangle> lifted =
      mesh::lifted_triangles(*geometry::make_surface(GetParam()), space->mesh,
                             mesh::build_cut_surface(space->mesh), *space->team);
  Vec c = random_vector(space->nodes(), 1), d = random_vector(space->nodes(), 2);
};

TEST_P(OperatorTest, MatricesAreTheIntegralsTheyStandFor) {
  const auto integral = [&](const auto& f) { return integrate(*space, lifted, c, f); };
  EXPECT_NEAR(
      space->mass.bilinear(c, c, *space->team) / integral([](double v, double) { return v * v; }),
      1, 1e-12);
  EXPECT_NEAR(space->stiffness.bilinear(c, c, *space->team) /
                  integral([](double, double squared_slope) { return squared_slope; }),
              1, 1e-12);
  EXPECT_NEAR(space->integral(c), integral([](double v, double) { return v; }), 1e-12);
}

TEST_P(OperatorTest, MatricesAreSymmetricAndVanishOnConstants) {
  const Vec one = Vec::Ones(space->nodes());
  for (const CsrMatrix* matrix : {&space->stiffness, &space->normal_stiffness}) {
    Vec r(space->nodes());
    matrix->multiply(one, r, *space->team);
    EXPECT_LT(r.cwiseAbs().maxCoeff(), 1e-13);
  }
  for (const CsrMatrix* matrix : {&space->mass, &space->stiffness, &space->normal_stiffness}) {
    const Eigen::MatrixXd full = dense(*matrix);
    EXPECT_EQ((full - full.transpose()).cwiseAbs().maxCoeff(), 0);
  }
}

// The prototype measured 14–26, nearly independent of h: that is what the stabilisation is for.
TEST_P(OperatorTest, StabilisedMassIsWellConditionedAfterDiagonalScaling) {
  Eigen::MatrixXd full = dense(space->stabilised_mass);
  const Vec scale = full.diagonal().cwiseSqrt().cwiseInverse();
  full = scale.asDiagonal() * full * scale.asDiagonal();
  const Vec eigenvalues = openblas::symmetric_eigen(full).values;
  EXPECT_GT(eigenvalues.minCoeff(), 0);
  EXPECT_LT(eigenvalues.maxCoeff() / eigenvalues.minCoeff(), 40);
}

TEST_P(OperatorTest, MassIsInverted) {
  Vec b(space->nodes()), x(space->nodes());
  space->stabilised_mass.multiply(c, b, *space->team);
  ASSERT_TRUE(space->solve_mass(b, x).ok());
  EXPECT_LT((x - c).norm() / c.norm(), 1e-11);
  EXPECT_NEAR(space->integral(x), b.sum(), 1e-14 * b.cwiseAbs().sum());
}

TEST_P(OperatorTest, MobilityStiffnessIsTheWeightedIntegral) {
  const physics::MobilityPtr law =
      physics::make_mobility("degenerate:outside=-1");  // needs the floor
  const std::vector<double> integral = mobility_integrals(*space, *law, c);
  // Reference: ∫ c(1 − c) tetrahedron by tetrahedron.
  std::vector<double> expected(space->elements.size(), 0.0);
  const Vec trace = fem::trace(*space, c);
  for (std::size_t k = 0; k < space->surface.triangles.size(); ++k) {
    const auto& triangle = space->surface.triangles[k];
    for (const auto& [at, weight] : kDegreeFourRule) {
      double value = 0;
      for (int v = 0; v < 3; ++v) value += at[v] * trace[triangle[v]];
      expected[space->surface.triangle_tet[k]] += weight * lifted[k].area * value * (1 - value);
    }
  }
  int floored = 0;
  for (std::size_t e = 0; e < integral.size(); ++e) {
    EXPECT_NEAR(integral[e], std::max(0.0, expected[e]), 1e-12 * space->elements[e].area);
    floored += expected[e] <= 0;
  }
  EXPECT_GT(floored, 10) << "the floor was not tried";

  CsrMatrix matrix(space->pattern);
  assemble_mobility_stiffness(*space, integral, matrix);
  Vec assembled(space->nodes()), direct = Vec::Zero(space->nodes());
  matrix.multiply(d, assembled, *space->team);
  add_mobility_flux(*space, integral, d, direct);
  EXPECT_LT((assembled - direct).norm(), 1e-13 * direct.norm());
  EXPECT_LT(std::fabs(direct.sum()), 1e-14 * direct.cwiseAbs().sum()) << "mass leaks";
  EXPECT_GT(openblas::symmetric_eigen(dense(matrix)).values.minCoeff(), -1e-12);
}

TEST_P(OperatorTest, PotentialIsTheGradientOfItsEnergy) {
  const physics::DoubleWell well{0.7, -0.3, 1.1};
  for (const PotentialRule rule : {PotentialRule::averaged, PotentialRule::consistent}) {
    const auto energy = [&](const Vec& at) { return potential_energy(*space, well, rule, at); };
    Vec b = Vec::Zero(space->nodes());
    add_potential(*space, well, rule, 1, c, b);
    // Exact for polynomials of degree four, as the energy is one.
    const double step = 0.1;
    const auto difference = [&](double s) { return energy(c + s * d) - energy(c - s * d); };
    EXPECT_NEAR(b.dot(d) / ((8 * difference(step) - difference(2 * step)) / (12 * step)), 1, 1e-11);
  }
  EXPECT_NEAR(potential_energy(*space, well, PotentialRule::consistent, c) /
                  integrate(*space, lifted, c, [&](double v, double) { return well.energy(v); }),
              1, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, OperatorTest, ::testing::Values("sphere", "torus", "dziuk"));

TEST(Threads, DoNotChangeABit) {
  const auto one = make_space(24, "sphere", 1), three = make_space(24, "sphere", 3);
  const auto model = testing::make_model();
  const problem::CahnHilliard first(one, model), second(three, model);
  const Vec y = testing::random_state(first, 5), ydot = random_vector(first.size(), 6);
  Vec r1(first.size()), r2(first.size());
  ASSERT_TRUE(first.residual(0, y, ydot, r1).ok());
  ASSERT_TRUE(second.residual(0, y, ydot, r2).ok());
  EXPECT_EQ(r1, r2);
  EXPECT_EQ(first.energy(y), second.energy(y));
  linear::BlockJacobian J1 = first.make_jacobian(), J2 = second.make_jacobian();
  ASSERT_TRUE(first.jacobian(0, y, ydot, 2.5, linear::Tangent::exact, J1).ok());
  ASSERT_TRUE(second.jacobian(0, y, ydot, 2.5, linear::Tangent::exact, J2).ok());
  EXPECT_EQ(J1.cc.values, J2.cc.values);
  EXPECT_EQ(J1.cm.values, J2.cm.values);
  EXPECT_EQ(J1.mc.values, J2.mc.values);
}

TEST(DoubleWell, HasTheDerivativesItClaims) {
  const physics::DoubleWell well{0.4, -1, 2};
  for (double c = -1.5; c < 2.5; c += 0.1) {
    const double h = 1e-5;
    EXPECT_NEAR(well.derivative(c), (well.energy(c + h) - well.energy(c - h)) / (2 * h), 1e-7);
    EXPECT_NEAR(well.second(c), (well.derivative(c + h) - well.derivative(c - h)) / (2 * h), 1e-7);
  }
  // ∫ √(2 f0) dc between the wells.
  double integral = 0;
  for (int i = 0; i < 30000; ++i)
    integral += 1e-4 * std::sqrt(2 * well.energy(-1 + (i + 0.5) * 1e-4));
  EXPECT_NEAR(well.interface_energy(), integral, 1e-6);
  EXPECT_NEAR(physics::DoubleWell{}.interface_energy(), 1 / (6 * std::sqrt(2.0)), 1e-15);
  // The profile solves ε² c'' = f0'(c).
  const double e = 0.3, s = 0.17, h = 1e-3;
  const double second =
      (well.profile(s + h, e) - 2 * well.profile(s, e) + well.profile(s - h, e)) / (h * h);
  EXPECT_NEAR(e * e * second, well.derivative(well.profile(s, e)), 1e-4);
}

TEST(Mobilities, HaveTheDerivativesTheyClaim) {
  for (const physics::MobilityEntry& entry : physics::mobilities()) {
    const physics::MobilityPtr law = physics::make_mobility(entry.name);
    for (double c = -0.325; c < 1.3; c += 0.05) {  // not at the kinks 0 and 1
      const double at[3] = {c - 1e-6, c, c + 1e-6};
      double value[3], slope[3];
      law->evaluate(at, 3, value, slope);
      EXPECT_NEAR(slope[1], (value[2] - value[0]) / 2e-6, 1e-8) << entry.name;
    }
  }
}

}  // namespace
}  // namespace traceraft::fem
