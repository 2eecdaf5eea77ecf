#include "verification/assimilation/forecast/curvature_contrast.hpp"

#include <gtest/gtest.h>

#include "tests/support/spaces.hpp"

namespace traceraft::assimilation {
namespace {

double contrast(const std::string& surface) {
  return curvature_contrast(*geometry::make_surface(surface),
                            testing::make_space(16, surface)->surface.position);
}

TEST(CurvatureContrast, IsThatOfKnownSurfaces) {
  EXPECT_LT(contrast("sphere"), 0.02);
  // 1/2 (1/minor + cos θ/(major + minor cos θ)) from the inner to the outer equator.
  const double inner = 0.5 * (1 / 0.4 - 1 / 0.6), outer = 0.5 * (1 / 0.4 + 1 / 1.4);
  EXPECT_NEAR(contrast("torus:major=1,minor=0.4"), (outer - inner) / outer, 0.05);
}

}  // namespace
}  // namespace traceraft::assimilation
