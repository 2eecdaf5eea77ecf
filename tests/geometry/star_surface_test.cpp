#include "kernel/geometry/star_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/core/error.hpp"
#include "kernel/geometry/differences.hpp"

namespace traceraft::geometry {
namespace {

LevelSetPtr given(std::function<double(const Point&)> phi) {
  return std::make_shared<FunctionLevelSet>(std::move(phi));
}

std::string complaint(const LevelSetPtr& surface, const Point& direction) {
  try {
    (void)StarSurface(surface).radius(direction.normalized());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(StarSurface, KnowsWhereRaysMeetAnEllipsoid) {
  const StarSurface surface(make_surface("ellipsoid:a=1.3,b=0.9,c=0.6"));
  EXPECT_FALSE(surface.is_unit_sphere());
  EXPECT_EQ(surface.centre(), Point(0, 0, 0));
  for (const Point& at : {Point(1, 2, 3), Point(-1, 0.1, 0), Point(0, 0, 1), Point(0.2, -1, 0.7)}) {
    const Point s = at.normalized();
    EXPECT_NEAR(surface.radius(s), 1 / Point(s[0] / 1.3, s[1] / 0.9, s[2] / 0.6).norm(), 1e-13);
  }
}

TEST(StarSurface, FindsTheCentreOfAUnitSphere) {
  const Point centre(0.1, -0.05, 0.2);
  const StarSurface moved(std::make_shared<ShiftedLevelSet>(make_surface("sphere"), centre));
  EXPECT_TRUE(moved.is_unit_sphere());
  EXPECT_LT((moved.centre() - centre).norm(), 1e-12);
  EXPECT_NEAR(moved.radius(Point(1, 2, -2) / 3), 1, 1e-12);
  EXPECT_FALSE(StarSurface(make_surface("ellipsoid:a=1,b=1,c=0.999")).is_unit_sphere());
}

TEST(StarSurface, TakesTheSurfacesLikeASphere) {
  for (const char* name : {"sphere", "ellipsoid", "biconcave", "dziuk"})
    for (double z = -1; z <= 1; z += 0.1)
      EXPECT_EQ(complaint(make_surface(name), {std::cos(7 * z), std::sin(7 * z), z}), "") << name;
}

TEST(StarSurface, SaysWhereASurfaceIsNotLikeASphere) {
  EXPECT_EQ(complaint(make_surface("torus"), {1, 0, 0}), "the origin lies outside this surface");
  const LevelSetPtr dented = given([](const Point& x) {
    return std::max(x.norm() - 1.2, 0.3 - (x - Point(0.4, 0.4, 0.4)).norm());
  });
  EXPECT_NE(complaint(dented, {1, 1, 1}).find("meets the surface more than once"),
            std::string::npos);
  const LevelSetPtr open = given([](const Point& x) { return x[0] + x[1] + x[2] - 1; });
  EXPECT_NE(complaint(open, {1, 0, 0}).find("does not meet"), std::string::npos);
}

// The axes of an ellipsoid have the curvatures a/b² and a/c² at the end of a.
TEST(LevelSetDerivatives, GiveTheCurvatures) {
  const double a = 1.2, b = 1, c = 0.8;
  const LevelSetDerivatives end(*make_surface("ellipsoid:a=1.2,b=1,c=0.8"), {a, 0, 0});
  EXPECT_NEAR(end.div_normal(), a / (b * b) + a / (c * c), 1e-7);
  EXPECT_NEAR(end.gaussian_curvature(), a / (b * b) * a / (c * c), 1e-7);
  // A cylinder, along whose axis nothing bends.
  const LevelSetPtr cylinder =
      given([](const Point& x) { return std::hypot(x[0], x[1] + x[2]) - 0.5; });
  EXPECT_NEAR(LevelSetDerivatives(*cylinder, {0.3, 0.1, 0.3}).gaussian_curvature(), 0, 1e-7);
  // A saddle: z = x² − y² at the origin.
  const LevelSetPtr saddle = given([](const Point& x) { return x[2] - x[0] * x[0] + x[1] * x[1]; });
  EXPECT_NEAR(LevelSetDerivatives(*saddle, {0, 0, 0}).gaussian_curvature(), -4, 1e-7);
}

}  // namespace
}  // namespace traceraft::geometry
