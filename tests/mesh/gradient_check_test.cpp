#include "kernel/mesh/gradient_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/spaces.hpp"

namespace traceraft::mesh {
namespace {

// The complaint about the sphere as the zero of f(|x|² − 1), "" if there is none.
template <class F>
std::string complaint(const F& f, int cells = 32) {
  try {
    const auto surface = std::make_shared<geometry::FunctionLevelSet>(
        [f](const Point& x) { return f(x.squaredNorm() - 1); });
    const fem::SurfaceSpace space(surface, cells, std::make_shared<ThreadTeam>(1),
                                  std::make_shared<SerialCommunicator>());
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(GradientCheck, TakesEverySurfaceOnTheMeshesThatResolveIt) {
  for (const std::string& name : geometry::surfaces().names())
    for (const int cells : {32, 48, 64}) EXPECT_NO_THROW(testing::make_space(cells, name)) << name;
}

TEST(GradientCheck, TakesAnyScaleAndAProfileThatTheMeshResolves) {
  for (const double scale : {1e-12, 1.0, 1e12})
    EXPECT_EQ(complaint([=](double s) { return scale * s; }), "");
  EXPECT_EQ(complaint([](double s) { return std::tanh(s / 0.3); }), "");
  EXPECT_EQ(complaint([](double s) { return s * s * s + 0.1 * s; }), "");
}

// The area of a sphere was 8 % off without a word.
TEST(GradientCheck, RefusesALevelSetWithoutAGradient) {
  for (const int cells : {8, 16, 32, 64})
    EXPECT_NE(complaint([](double s) { return s * s * s; }, cells).find("hardly any gradient"),
              std::string::npos)
        << cells;
  EXPECT_NE(complaint([](double s) { return s * std::fabs(s); }).find("hardly any gradient"),
            std::string::npos);
}

TEST(GradientCheck, RefusesALevelSetThatJumps) {
  EXPECT_NE(complaint([](double s) { return s < 0 ? -1.0 : 1.0; }).find("jumps at its surface"),
            std::string::npos);
  EXPECT_NE(complaint([](double s) { return std::cbrt(s); }).find("jumps at its surface"),
            std::string::npos);
}

TEST(GradientCheck, ComparesWithTheGradientAcrossACell) {
  const geometry::FunctionLevelSet curved([](const Point& x) { return x[0] * x[0] * x[0] + x[0]; });
  EXPECT_NEAR(relative_gradient(curved, Point(0, 0, 0), 2), 0.5, 1e-6);
  EXPECT_NEAR(relative_gradient(*geometry::make_surface("sphere"), Point(1, 0, 0), 0.1), 1, 1e-2);
}

}  // namespace
}  // namespace traceraft::mesh
