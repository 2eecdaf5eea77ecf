#include "verification/analytic/surface_calculus.hpp"

#include <gtest/gtest.h>

#include "verification/analytic/manufactured.hpp"

namespace traceraft {
namespace {

const auto kSphere = [](const auto& x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 1.0; };
const analytic::Vector3<double> kPlace = {0.48, 0.6, 0.64};  // on the unit sphere

TEST(Jet, FollowsTheChainRule) {
  const auto x = analytic::with_derivatives(analytic::Vector3<double>{2, 3, 5});
  const analytic::Jet<double> f =
      analytic::sqrt(x[0] * x[0] * x[1]) + 7.0 * x[2] - analytic::inverse(x[1]);
  EXPECT_NEAR(f.value, 2 * std::sqrt(3.0) + 35 - 1.0 / 3, 1e-13);
  EXPECT_NEAR(f.gradient[0], std::sqrt(3.0), 1e-13);
  EXPECT_NEAR(f.gradient[1], 1 / std::sqrt(3.0) + 1.0 / 9, 1e-13);
  EXPECT_NEAR(f.gradient[2], 7, 1e-13);
  EXPECT_NEAR(f.second(0, 0), 0, 1e-13);
  EXPECT_NEAR(f.second(0, 1), 1 / (2 * std::sqrt(3.0)), 1e-13);
  EXPECT_NEAR(f.second(1, 1), -0.5 * 2 / (2 * std::pow(3.0, 1.5)) - 2.0 / 27, 1e-13);
}

// A spherical harmonic of degree 3, to the fourth derivative.
TEST(SurfaceCalculus, KnowsTheEigenvaluesOfTheSphere) {
  const auto u = [](const auto& x) { return x[0] * x[1] * x[2]; };
  const auto laplacian = analytic::laplace_beltrami(kSphere, u);
  const auto twice = analytic::laplace_beltrami(kSphere, laplacian);
  EXPECT_NEAR(laplacian(kPlace), -12 * u(kPlace), 1e-12);
  EXPECT_NEAR(twice(kPlace), 144 * u(kPlace), 1e-10);
}

// The values of a function away from the surface change nothing.
TEST(SurfaceCalculus, DoesNotSeeTheExtension) {
  const auto u = [](const auto& x) { return x[0] * x[1] * x[2] + 3.0 * (kSphere(x) * x[0]); };
  EXPECT_NEAR(analytic::laplace_beltrami(kSphere, u)(kPlace), -12 * 0.48 * 0.6 * 0.64, 1e-12);
}

TEST(SurfaceCalculus, CurvatureOfTheTorus) {
  const auto torus = [](const auto& x) {
    using std::sqrt;
    const auto tube = sqrt(x[0] * x[0] + x[1] * x[1]) - 1.0;
    return tube * tube + x[2] * x[2] - 0.16;
  };
  // On the outer equator 1/r + 1/(R + r), on the inner one 1/r − 1/(R − r).
  for (const auto& [x, expected] : {std::pair(1.4, 2.5 + 1 / 1.4), std::pair(0.6, 2.5 - 1 / 0.6)}) {
    const analytic::LocalSurface<double> local(
        torus(analytic::with_derivatives(analytic::Vector3<double>{x, 0, 0})));
    EXPECT_NEAR(local.div_normal, expected, 1e-12);
  }
}

// function() takes points near the surface to it: from a point on it, differences along the
// gradient are those of u on the surface, and ∇_Γ Δ_Γ u those of Δ_Γ u.
TEST(SurfaceCalculus, GradientsAreThoseOfDifferences) {
  // On each of the surfaces.
  for (const auto& [name, place] : {std::pair("sphere", Point(0.48, 0.6, 0.64)),
                                    std::pair("ellipsoid", Point(1.2 * 0.48, 0.6, 0.8 * 0.64)),
                                    std::pair("torus", Point(1.24 * 0.6, 1.24 * 0.8, 0.32))}) {
    const analytic::SurfaceFunction function = analytic::surface_function(name);
    const analytic::SurfacePoint p = function(place);
    const double step = 1e-5;
    for (const auto& [gradient, value] :
         {std::pair(p.gradient, &analytic::SurfacePoint::u),
          std::pair(p.laplacian_gradient, &analytic::SurfacePoint::laplacian)}) {
      const Point along = gradient.normalized();
      const double slope =
          (function(place + step * along).*value - function(place - step * along).*value) /
          (2 * step);
      EXPECT_NEAR(slope / gradient.norm(), 1, 1e-5) << name;
    }
  }
}

}  // namespace
}  // namespace traceraft
