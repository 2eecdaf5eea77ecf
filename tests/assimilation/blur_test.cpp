// Blur of spherical harmonics, which it only makes smaller, and of what is uniform, which it
// leaves.
#include "verification/assimilation/fields/blur.hpp"

#include <gtest/gtest.h>

#include "verification/assimilation/forecast/resolved_forecast.hpp"
#include "verification/bench/bench.hpp"

namespace traceraft::assimilation {
namespace {

Vec nodal(const fem::SurfaceSpace& space, const std::function<double(const Point&)>& f) {
  Vec values(space.nodes());
  for (int k = 0; k < space.nodes(); ++k) values[k] = f(space.mesh.position(k).normalized());
  return values;
}

TEST(Blur, IsThatOfAGaussian) {
  const bench::SpacePtr space = serial_space(geometry::make_surface("sphere"), 32);
  constexpr double kWidth = 0.2;
  const Blur blur(*space, kWidth);
  const Vec uniform = Vec::Constant(space->nodes(), 0.7);
  EXPECT_LT((blur.blurred(uniform) - uniform).cwiseAbs().maxCoeff(), 1e-10);
  // −Δ Y = l (l + 1) Y, so that Y shrinks by exp(−l (l + 1) width²/2).
  const Vec harmonic = nodal(*space, [](const Point& x) { return x[0] * x[1] * x[2]; });
  const Vec after = blur.blurred(harmonic);
  const double share = space->inner(after, harmonic) / space->inner(harmonic, harmonic);
  EXPECT_NEAR(share, std::exp(-12 * kWidth * kWidth / 2), 0.01);
  const Vec none = Blur(*space, 0).blurred(harmonic);
  EXPECT_LT((none - harmonic).cwiseAbs().maxCoeff(), 1e-10);
}

}  // namespace
}  // namespace traceraft::assimilation
