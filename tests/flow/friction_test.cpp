#include "kernel/flow/friction.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>

#include "kernel/geometry/differences.hpp"
#include "tests/support/harmonics.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::flow {
namespace {

using geometry::LevelSetPtr;
using geometry::StarSurface;
using testing::random_directions;
using testing::random_vector;

constexpr int kDegree = 12;
const std::string kTriaxial = "ellipsoid:a=1.2,b=1,c=0.8",
                  kSpheroid = "ellipsoid:a=1.1,b=1.1,c=0.8";

std::shared_ptr<const Friction> friction_of(const LevelSetPtr& surface, double water,
                                            int degree = kDegree) {
  return make_friction(StarSurface(surface), {1, water, 1}, degree);
}

// The coefficients of a function of places on the surface: least squares at many of them.
template <class Function>
Vec harmonics_of(const LevelSetPtr& level_set, const Function& function, int degree = kDegree) {
  const StarSurface surface(level_set);
  const std::vector<Point> rays = random_directions(3 * (degree + 1) * (degree + 1));
  Eigen::MatrixXd harmonics(rays.size(), harmonic_index(degree, degree) + 1);
  Vec values(rays.size());
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    values[row] = function(surface.centre() + surface.radius(rays[k]) * rays[k]);
    for (int l = 0; l <= degree; ++l)
      for (int m = -l; m <= l; ++m)
        harmonics(row, harmonic_index(l, m)) = testing::exact_harmonic(l, m, rays[k]);
  }
  return harmonics.householderQr().solve(values);
}

double potential(const Point& x) {
  return x[0] * x[1] + 0.5 * x[2] * x[2] * x[2] - x[0] + 0.3 * x[1] * x[1];
}

// n × ∇ψ with both as functions in space.
Point velocity(const geometry::LevelSet& surface, const Point& x) {
  const Point slope(x[1] - 1, x[0] + 0.6 * x[1], 1.5 * x[2] * x[2]);
  return geometry::LevelSetDerivatives(surface, x).normal().cross(slope);
}

// 2 |E(u)|² of the tangential part of the symmetric gradient.
double shear(const geometry::LevelSet& surface, const Point& x) {
  constexpr double kStep = 1e-3;
  Eigen::Matrix3d gradient;
  for (int i = 0; i < 3; ++i) {
    const Point a = kStep * Point::Unit(i);
    gradient.col(i) = (velocity(surface, x + a) - velocity(surface, x - a)) / (2 * kStep);
  }
  const Point n = geometry::LevelSetDerivatives(surface, x).normal();
  const Eigen::Matrix3d P = Eigen::Matrix3d::Identity() - n * n.transpose(),
                        E = 0.5 * P * (gradient + gradient.transpose()) * P;
  return 2 * E.squaredNorm();
}

// By places of the unit sphere: x = (a s_x, b s_y, c s_z), dA = |(b c s_x, a c s_y, a b s_z)| dΩ.
double shear_of_ellipsoid(const geometry::LevelSet& surface, const Point& axes) {
  constexpr int kRings = 100;
  double sum = 0;
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < 2 * kRings; ++j) {
      const double theta = (i + 0.5) * kPi / kRings, phi = j * kPi / kRings;
      const Point s(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                    std::cos(theta));
      sum += std::sin(theta) * std::pow(kPi / kRings, 2) * axes.prod() *
             s.cwiseQuotient(axes).norm() * shear(surface, s.cwiseProduct(axes));
    }
  return sum;
}

// The power is linear in the drag of the water: what is left without water.
double power_of_membrane(const LevelSetPtr& surface, const Vec& psi) {
  const double one = friction_of(surface, 1)->power(psi), two = friction_of(surface, 2)->power(psi);
  return 2 * one - two;
}

TEST(Friction, OfTheMembraneIsThatOfItsShear) {
  const LevelSetPtr surface = geometry::make_surface(kTriaxial);
  const double exact = shear_of_ellipsoid(*surface, {1.2, 1, 0.8});
  EXPECT_NEAR(power_of_membrane(surface, harmonics_of(surface, potential)), exact, 1e-3 * exact);
}

// A sphere that is not of unit size, beside its centre: eigenvalues l(l + 1)/a² of −Δ, K = 1/a².
TEST(Friction, IsThatOfAnySphere) {
  constexpr double kRadius = 0.9, kWater = 0.7;
  const Point centre(0.15, 0.1, -0.05);
  const auto surface = std::make_shared<geometry::FunctionLevelSet>(
      [centre](const Point& x) { return (x - centre).norm() - kRadius; });
  for (const int l : {1, 2, 3}) {
    const Vec psi = harmonics_of(
        surface, [&](const Point& x) { return testing::exact_harmonic(l, 1, x - centre); });
    const double exact = FluidMembrane{1, kWater * kRadius, 1}.friction(l) / (kRadius * kRadius);
    EXPECT_NEAR(friction_of(surface, kWater)->power(psi), exact, 1e-4 * exact) << l;
  }
}

// Its stream function, ∫ ρ ds along a meridian, has u = e_z × x.
double rotation(const Point& x) {
  const double a = 1.1, c = 0.8, end = std::asin(x[2] / c);
  double sum = 0;
  constexpr int kSteps = 400;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = (k + 0.5) / kSteps * end;
    sum +=
        a * std::cos(angle) * std::hypot(a * std::sin(angle), c * std::cos(angle)) * end / kSteps;
  }
  return sum;
}

TEST(Friction, RotationsFeelTheWaterAlone) {
  const LevelSetPtr surface = geometry::make_surface(kSpheroid);
  const Vec psi = harmonics_of(surface, rotation);
  EXPECT_LT(std::fabs(power_of_membrane(surface, psi)), 1e-5 * friction_of(surface, 1)->power(psi));
}

TEST(Friction, NoCapillaryForceTurnsASpheroid) {
  const LevelSetPtr surface = geometry::make_surface(kSpheroid);
  const Vec turn = harmonics_of(surface, rotation);
  const auto friction = friction_of(surface, 0.8);
  const Vec driven = friction->capillary(random_vector(turn.size(), 1));
  // ψᵀ F of the rotation, from powers.
  const double along = 0.25 * (friction->power(driven + turn) - friction->power(driven - turn));
  EXPECT_LT(std::fabs(along), 1e-4 * std::sqrt(friction->power(driven) * friction->power(turn)));
  // A triaxial ellipsoid does not turn into itself: its force drives what it can.
  const auto triaxial = friction_of(geometry::make_surface(kTriaxial), 0.8);
  Vec force = random_vector(turn.size(), 2);
  force[0] = 0;
  const Vec flow = triaxial->capillary(force);
  EXPECT_NEAR(triaxial->power(flow), force.dot(flow), 1e-9 * triaxial->power(flow));
}

// The capillary flow is C f with C = F⁻¹ less the rotations: tr F C is the number of flows less
// that of rotations.
double number_of_rotations(const Friction& friction) {
  const Eigen::Index size = harmonic_index(kDegree, kDegree) + 1;
  double trace = 0;
  for (Eigen::Index i = 1; i < size; ++i) {
    const Vec force = Vec::Unit(size, i), flow = friction.capillary(force);
    trace += 0.25 * (friction.power(flow + force) - friction.power(flow - force));
  }
  return static_cast<double>(size - 1) - trace;
}

TEST(Friction, LeavesOutTheRotationsOfASurface) {
  const auto sphere_beside_its_centre = std::make_shared<geometry::FunctionLevelSet>(
      [](const Point& x) { return (x - Point(0.15, 0.1, -0.05)).norm() - 0.9; });
  EXPECT_NEAR(number_of_rotations(*friction_of(sphere_beside_its_centre, 0.8)), 3, 1e-6);
  const std::pair<std::string, int> surfaces[] = {
      {"sphere", 3}, {kSpheroid, 1}, {"biconcave", 1}, {kTriaxial, 0}, {"dziuk", 0}};
  for (const auto& [name, rotations] : surfaces)
    EXPECT_NEAR(number_of_rotations(*friction_of(geometry::make_surface(name), 0.8)), rotations,
                1e-6)
        << name;
}

// E ψᵀ F ψ is the number of harmonics, whatever the surface.
TEST(Friction, ThermalFlowHasTheSamePowerInAllModes) {
  for (const std::string& name : {std::string("sphere"), kTriaxial, std::string("biconcave")}) {
    const auto friction = friction_of(geometry::make_surface(name), 0.8);
    const Eigen::Index size = harmonic_index(kDegree, kDegree) + 1;
    double sum = 0;
    constexpr int kDraws = 50;
    for (std::uint64_t k = 0; k < kDraws; ++k) {
      Vec normal(size);
      for (Eigen::Index i = 0; i < size; ++i)
        normal[i] = normal_random(3, k, static_cast<std::uint64_t>(i));
      sum += friction->power(friction->brownian(normal)) / kDraws;
    }
    const auto modes = static_cast<double>(size - 1);
    EXPECT_NEAR(sum / modes, 1, 4 * std::sqrt(2 / (modes * kDraws))) << name;
  }
}

}  // namespace
}  // namespace traceraft::flow
