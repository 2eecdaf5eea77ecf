#include "kernel/problem/initial_data.hpp"

#include <gtest/gtest.h>

#include "kernel/fem/trace.hpp"
#include "kernel/observables/rafts.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::problem {
namespace {

using testing::make_space;

double mean(const fem::SurfaceSpace& space, const Vec& c) {
  return space.integral(c) / space.area;
}

TEST(Noise, MeetsTheFractionExactlyWithoutRedrawing) {
  const auto space = make_space(16);
  for (const double fraction : {0.0, 0.1, 0.16, 0.5, 0.999, 1.0})
    for (const std::int64_t cells : {16, 8, 5, 4})
      for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        InitialRequest request;
        request.raft_fraction = fraction;
        request.noise_cells = cells;
        request.seed = seed;
        EXPECT_NEAR(mean(*space, make_initial_field("noise", *space, request)), fraction, 1e-13);
      }
}

TEST(Noise, IsTheSameFieldOnARefinedMesh) {
  const auto coarse = make_space(16), fine = make_space(32);
  InitialRequest request;
  request.noise_cells = 8;
  const Vec on_coarse = bernoulli_noise().nodal(*coarse, request, Parameters({}, {}));
  const Vec on_fine = bernoulli_noise().nodal(*fine, request, Parameters({}, {}));
  int compared = 0, different = 0;
  for (int i = 0; i < coarse->nodes(); ++i)
    for (int j = 0; j < fine->nodes(); ++j) {
      if ((coarse->mesh.position(i) - fine->mesh.position(j)).norm() > 1e-12) continue;
      ++compared;
      different += std::fabs(on_coarse[i] - on_fine[j]) > 1e-12;
    }
  EXPECT_GT(compared, 200);
  // Only nodes near the one on the threshold may differ: the two meshes weigh it differently.
  EXPECT_LT(different, compared / 20);
}

TEST(Noise, DependsOnTheSeedAndNotOnThreads) {
  const auto one = make_space(16, "sphere", 1), two = make_space(16, "sphere", 2);
  InitialRequest request;
  const Vec first = make_initial_field("noise", *one, request);
  EXPECT_EQ(first, make_initial_field("noise", *two, request));
  request.seed = 2;
  EXPECT_GT((first - make_initial_field("noise", *one, request)).norm(), 1);
}

TEST(Noise, OfNodesIsABernoulliDraw) {
  const auto space = make_space(24);
  InitialRequest request;
  request.raft_fraction = 0.3;
  const Vec raw = bernoulli_noise().nodal(*space, request, Parameters({}, {}));
  int ones = 0, partly = 0;
  for (const double value : raw) {
    ones += value == 1;
    partly += value != 0 && value != 1;
  }
  EXPECT_LE(partly, 1);
  EXPECT_NEAR(static_cast<double>(ones) / space->nodes(), 0.3, 0.04);
}

TEST(BandLimitedNoise, HasItsMeanAndItsSpread) {
  const auto space = make_space(24);
  InitialRequest request;
  request.raft_fraction = 0.4;
  const Vec c = make_initial_field("band-limited:wavelength=0.8,amplitude=0.1", *space, request);
  EXPECT_NEAR(mean(*space, c), 0.4, 1e-13);
  const Vec deviation = c.array() - 0.4;
  EXPECT_NEAR(std::sqrt(space->inner(deviation, deviation) / space->area), 0.1, 0.04);
}

TEST(Caps, ArePlacedWhereTheyWereAskedFor) {
  const auto space = make_space(48);
  InitialRequest request;
  request.epsilon = 0.04;
  request.caps = {{{0, 0, 1}, 0.8}, {{2, 0, -1}, 0.5}};
  const Vec c = make_initial_field("caps", *space, request);
  const observables::RaftReport report = observables::RaftFinder(space).find(c, 0.5);
  ASSERT_EQ(report.rafts.size(), 2u);
  EXPECT_NEAR(report.rafts[0].area, 2 * M_PI * (1 - std::cos(0.8)), 0.02);
  EXPECT_NEAR(report.rafts[0].perimeter, 2 * M_PI * std::sin(0.8), 0.05);
  EXPECT_NEAR(report.rafts[1].area, 2 * M_PI * (1 - std::cos(0.5)), 0.02);
  EXPECT_NEAR(report.rafts[1].perimeter, 2 * M_PI * std::sin(0.5), 0.05);
  // The centre of a cap's area is halfway between its pole and the plane of its rim.
  const auto depth = [](double angle) { return 0.5 * (1 - std::cos(angle)); };
  const double angles[] = {0.8, 0.5};
  const Point axes[] = {{0, 0, 1}, Point(2, 0, -1).normalized()};
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT((report.rafts[k].centre - (1 - depth(angles[k])) * axes[k]).norm(), 0.01);
    EXPECT_NEAR(report.rafts[k].distance, depth(angles[k]), 0.02);
  }
  // The length of a direction means nothing, even if its square is no number.
  request.caps = {{{0, 0, 1e308}, 0.8}, {{2e-310, 0, -1e-310}, 0.5}};
  EXPECT_LT((make_initial_field("caps", *space, request) - c).lpNorm<Eigen::Infinity>(), 1e-12);
}

TEST(Formula, IsProjected) {
  const auto space = make_space(32);
  InitialRequest request;
  EXPECT_THROW(make_initial_field("formula", *space, request), InputError);
  request.formula = [](const Point& x) { return 0.5 + 0.3 * x[2]; };
  const Vec c = make_initial_field("formula", *space, request);
  const Vec trace = fem::trace(*space, c);
  double worst = 0;
  for (int p = 0; p < trace.size(); ++p)
    worst = std::max(worst, std::fabs(trace[p] - request.formula(space->surface.position[p])));
  EXPECT_LT(worst, 0.02);
  request.formula = [](const Point& x) { return 1 / (x[0] - x[0]); };
  EXPECT_THROW(make_initial_field("formula", *space, request), InputError);
}

TEST(Formula, IsTakenOnTheSurfaceWhereThatIsKnown) {
  const auto space = make_space(16);
  InitialRequest request;
  request.surface = geometry::make_surface("sphere");
  // ∫ z² = 4π/3, and acos(z) is a number on the sphere alone.
  request.formula = [](const Point& x) { return x[2] * x[2] + 0 * std::acos(0.999999 * x[2]); };
  const Vec c = make_initial_field("formula", *space, request);
  EXPECT_NEAR(space->integral(c), 4 * kPi / 3, 1e-4);
  request.surface = nullptr;
  EXPECT_GT(
      std::fabs(space->integral(make_initial_field("formula", *space, request)) - 4 * kPi / 3),
      1e-3);
}

TEST(Formula, ThatIsNotFiniteIsRefusedWithThePlace) {
  const auto space = make_space(16);
  InitialRequest request;
  request.surface = geometry::make_surface("sphere");
  request.formula = [](const Point& x) { return std::log(x[2] - 0.5); };
  try {
    make_initial_field("formula", *space, request);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("is not finite at ("), std::string::npos);
  }
}

TEST(InitialFields, UnknownNamesAreAnswered) {
  const auto space = make_space(8);
  EXPECT_THROW(make_initial_field("noize", *space, {}), InputError);
  EXPECT_THROW(make_initial_field("band-limited:wavelength=-1", *space, {}), InputError);
}

}  // namespace
}  // namespace traceraft::problem
