#include "kernel/flow/transport.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/spaces.hpp"

namespace traceraft::flow {
namespace {

using testing::make_space;
using testing::random_vector;

Vec transported(const fem::SurfaceSpace& space, const Vec& c, const Vec& psi) {
  Vec r = Vec::Zero(space.nodes());
  add_transport(space, element_curls(space), 1, c, psi, r);
  return r;
}

class TransportTest : public ::testing::TestWithParam<const char*> {
 protected:
  const std::shared_ptr<const fem::SurfaceSpace> space = make_space(24, GetParam());
  const Vec c = random_vector(space->nodes(), 1), psi = random_vector(space->nodes(), 2),
            v = random_vector(space->nodes(), 3);
};

TEST_P(TransportTest, KeepsMassAndConstants) {
  const Vec r = transported(*space, c, psi);
  EXPECT_NEAR(r.sum(), 0, 1e-13 * r.lpNorm<1>());
  const Vec still = transported(*space, Vec::Ones(space->nodes()), psi);
  EXPECT_LT(still.norm(), 1e-12 * r.norm());
}

// The power of the force is what the flow takes from the energy.
TEST_P(TransportTest, IsAntisymmetric) {
  const double power = v.dot(transported(*space, c, psi));
  EXPECT_NEAR(power, -psi.dot(transported(*space, c, v)), 1e-12 * std::fabs(power));
  const Vec own = transported(*space, c, psi);
  EXPECT_NEAR(psi.dot(own), 0, 1e-13 * psi.norm() * own.norm());
}

TEST_P(TransportTest, HasItsMatrix) {
  fem::CsrMatrix matrix(space->pattern);
  add_transport_matrix(*space, element_curls(*space), 0.5, psi, matrix);
  Vec product = Vec::Zero(space->nodes());
  matrix.multiply_add(2, c, product, *space->team);
  const Vec r = transported(*space, c, psi);
  EXPECT_LT((product - r).norm(), 1e-13 * r.norm());
}

INSTANTIATE_TEST_SUITE_P(Surfaces, TransportTest,
                         ::testing::Values("sphere", "torus", "ellipsoid:a=1.1,b=1,c=0.8"));

// ψ = z turns the sphere: u = n × e_z = (y, −x, 0), and ∫ x u·∇y = −∫ x² = −4π/3.
double error_of_rotation(int cells) {
  const auto space = make_space(cells);
  Vec x(space->nodes()), y(space->nodes()), z(space->nodes());
  for (int i = 0; i < space->nodes(); ++i) {
    const Point at = space->mesh.position(i).normalized();
    x[i] = at[0];
    y[i] = at[1];
    z[i] = at[2];
  }
  return y.dot(transported(*space, x, z)) + 4 * kPi / 3;
}

TEST(Transport, ConvergesToTheFlowOfItsStreamFunction) {
  const double coarse = std::fabs(error_of_rotation(12)), fine = std::fabs(error_of_rotation(24));
  EXPECT_LT(fine, 0.05);
  EXPECT_GT(std::log2(coarse / fine), 1.7);
}

}  // namespace
}  // namespace traceraft::flow
