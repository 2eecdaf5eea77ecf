#include "kernel/discs/ripening.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace traceraft::discs {
namespace {

DiscModel degenerate_model() {
  DiscModel result;
  result.mobility = physics::make_mobility("degenerate");
  result.epsilon = 0.01;
  return result;
}

// The lipids that each disc takes up per time.
Vec fluxes(const Ripening& ripening, const Contents& contents) {
  Contents rate;
  EXPECT_TRUE(ripening.rate(contents, rate));
  for (Eigen::Index i = 0; i < rate.area.size(); ++i)
    rate.area[i] *= ripening.phases().mass_slope(contents.area[i]) - ripening.background(contents);
  return rate.area;
}

// The mass with which discs take up from each other only.
double balanced_mass(const Ripening& ripening, Contents contents) {
  double low = 0, high = 4 * kPi;
  for (int k = 0; k < 100; ++k) {
    contents.mass = (low + high) / 2;
    const double around = ripening.background(contents);
    (around < 0.15 && (around < -0.2 || fluxes(ripening, contents).sum() < 0) ? low : high) =
        contents.mass;
  }
  return low;
}

// Between two caps at the poles G = A + B ln tan(θ/2), without any approximation.
TEST(RipeningTest, TwoDiscsAtThePolesExchangeWhatTheExactSolutionSays) {
  Ripening ripening(degenerate_model());
  const Phases& phases = ripening.phases();
  ripening.set_places({{{0, 0, 1}, 0.5}, {{0, 0, -1}, 0.2}});
  Contents contents{Vec(2), 0};
  contents.area << 0.5, 0.2;
  contents.mass = balanced_mass(ripening, contents);
  const Vec flux = fluxes(ripening, contents);
  const auto value = [&](int i) {
    return phases.flux_potential(phases.outside(phases.potential(contents.area[i])));
  };
  const auto angle = [&](int i) {
    return half_angle(contents.area[i]) +
           phases.tail(phases.outside(phases.potential(contents.area[i])));
  };
  const double slope = (value(1) - value(0)) / (std::log(std::tan((kPi - angle(1)) / 2)) -
                                                std::log(std::tan(angle(0) / 2)));
  EXPECT_GT(flux[0], 0);  // the large one grows
  EXPECT_NEAR(flux[0], 2 * kPi * slope, 1e-4 * flux[0]);
  EXPECT_NEAR(flux[1], -flux[0], 1e-4 * flux[0]);
}

// Any two caps are those at the poles by a conformal map, which keeps fluxes: their inversive
// distance I says which. Charges alone would exchange 14 to 33 % too little here, dipoles 1 to 9 %.
TEST(RipeningTest, TwoDiscsAnywhereExchangeWhatTheExactSolutionSays) {
  Ripening ripening(degenerate_model());
  const Phases& phases = ripening.phases();
  Contents contents{Vec(2), 0};
  contents.area << 0.4, 0.25;
  const auto value = [&](int i) {
    return phases.flux_potential(phases.outside(phases.potential(contents.area[i])));
  };
  const auto angle = [&](int i) {
    return half_angle(contents.area[i]) +
           phases.tail(phases.outside(phases.potential(contents.area[i])));
  };
  for (const double apart : {0.9, 1.1, 2.0}) {
    ripening.set_places({{{0, 0, 1}, 0.4}, {{std::sin(apart), 0, std::cos(apart)}, 0.25}});
    contents.mass = balanced_mass(ripening, contents);
    const double distance = (std::cos(angle(0)) * std::cos(angle(1)) - std::cos(apart)) /
                            (std::sin(angle(0)) * std::sin(angle(1)));
    const double exact = 2 * kPi * (value(1) - value(0)) / std::acosh(distance);
    EXPECT_NEAR(fluxes(ripening, contents)[0], exact, 1e-3 * exact) << apart;
  }
}

TEST(RipeningTest, ADiscInEquilibriumWithWhatIsAroundItRests) {
  Ripening ripening(degenerate_model());
  ripening.set_places({{{0, 0, 1}, 0.5}});
  Contents contents{Vec::Constant(1, 0.5), 0};
  const double around = ripening.phases().outside(ripening.phases().potential(0.5));
  contents.mass = ripening.phases().mass(0.5) + around * (4 * kPi - 0.5);
  EXPECT_NEAR(ripening.background(contents), around, 1e-14);
  EXPECT_NEAR(fluxes(ripening, contents)[0], 0, 1e-12);
  contents.mass += 0.1;
  EXPECT_GT(fluxes(ripening, contents)[0], 0);
}

// A disc near a large one loses to it, one that is as large and far away does so less.
TEST(RipeningTest, NeighboursCount) {
  Ripening ripening(degenerate_model());
  const Point near = Point(1, 0, 1).normalized(), far(0, 0, -1);
  const std::vector<Disc> discs = {{{0, 0, 1}, 0.5}, {near, 0.1}, {far, 0.1}};
  ripening.set_places(discs);
  Contents contents{Vec(3), 0};
  contents.area << 0.5, 0.1, 0.1;
  contents.mass = balanced_mass(ripening, contents);
  const Vec flux = fluxes(ripening, contents);
  EXPECT_LT(flux[1], 1.05 * flux[2]);
  EXPECT_LT(flux[2], 0);
}

}  // namespace
}  // namespace traceraft::discs
