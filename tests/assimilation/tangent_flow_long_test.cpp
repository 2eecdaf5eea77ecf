// Taylor tests: what remains after the first order falls with the square of the perturbation.
#include <gtest/gtest.h>

#include "backends/list.hpp"
#include "tests/support/spaces.hpp"
#include "verification/assimilation/forecast/candidates.hpp"
#include "verification/assimilation/forecast/tangent_flow.hpp"
#include "verification/selection/blind/effect_size.hpp"

namespace traceraft::assimilation {
namespace {

using testing::make_model;
using testing::make_space;

constexpr double kBegin = 1, kEnd = 1.6;
constexpr int kSteps = 48;

class TangentFlowTest : public ::testing::Test {
 protected:
  TangentFlowTest() : space(make_space(10)), base(space, make_model()) {
    c = advance(base, base.c_of(testing::noise_state(base, 3).y), 0, kBegin, 1).end;
    along = advance(base, c, kBegin, kEnd, kSteps);
  }

  Forecast advance(const problem::CahnHilliard& problem, VecView from, double begin, double end,
                   int steps) const {
    const auto make_integrator = [this](const problem::DaeProblem& p) {
      time::IntegratorSettings settings;
      settings.tolerance = 1e-9;
      return backends::integrators().find("ida").make(
          p, backends::choose_linear_solver("direct", *space), space->team, settings);
    };
    return forecast(problem, make_integrator, from, begin, end, {steps});
  }
  Columns derivative(Columns S, const Forcing& forcing = {}) const {
    TangentFlow flow(base, backends::choose_linear_solver("direct", *space).primary,
                     std::make_shared<ThreadTeam>(2));
    flow.advance(along.paths.front(), S, forcing);
    return S;
  }
  // `end`: the state for a perturbation of that size. Half of it leaves a quarter of the remainder.
  void expect_slope_two(const std::function<Vec(double)>& end, const Vec& slope, double step) {
    const double large = base.field_norm(end(step) - along.end - step * slope);
    const double small = base.field_norm(end(step / 2) - along.end - step / 2 * slope);
    EXPECT_LT(large, 0.2 * step * base.field_norm(slope));
    EXPECT_GT(large / small, 3.4);
    EXPECT_LT(large / small, 4.6);
  }

  std::shared_ptr<const fem::SurfaceSpace> space;
  problem::CahnHilliard base;
  Vec c;
  Forecast along;
};

TEST_F(TangentFlowTest, CarriesPerturbationsOfTheState) {
  Vec direction(space->nodes());
  for (int k = 0; k < space->nodes(); ++k) {
    const Point x = space->mesh.position(k);
    direction[k] = x[0] * x[1] + 0.5 * x[2];
  }
  direction = problem::project(*space, direction);
  expect_slope_two(
      [&](double step) { return advance(base, c + step * direction, kBegin, kEnd, kSteps).end; },
      derivative(direction), 0.05);
}

TEST_F(TangentFlowTest, KeepsTheMassOfPerturbations) {
  const Vec direction = problem::project(*space, testing::random_vector(space->nodes(), 5));
  const Vec moved = derivative(direction);
  EXPECT_NEAR(space->integral(moved), space->integral(direction), 1e-10);
}

// The change of the diffusion ratio is the same as that of the time.
TEST_F(TangentFlowTest, RateIsTheDerivativeByTime) {
  const double step = 1e-3;
  const Vec later = advance(base, c, kBegin, kEnd + step, 1).end;
  const Vec earlier = advance(base, c, kBegin, kEnd - step, 1).end;
  const Vec slope = (later - earlier) / (2 * step);
  EXPECT_LT(base.field_norm(slope - along.end_rate), 1e-3 * base.field_norm(slope));
}

// Points that an effect couples are no neighbours in the assembled Jacobian.
TEST_F(TangentFlowTest, IsExactWhereDistantPointsAreCoupled) {
  const auto& all = candidates();
  const Candidate& repulsion =
      *std::find_if(all.begin(), all.end(),
                    [](const Candidate& candidate) { return candidate.name == "ohta-kawasaki"; });
  constexpr double kStrength = 0.6;  // changes c by 6 % of its contrast
  const auto with = [&](double strength) {
    return problem::CahnHilliard(space,
                                 effects::with_effects(base.model(), {repulsion.term({strength})}));
  };
  const auto end = [&](double strength, VecView from) {
    return advance(with(strength), from, kBegin, kEnd, kSteps).end;
  };
  const problem::CahnHilliard problem = with(kStrength);
  const Forecast path = advance(problem, c, kBegin, kEnd, kSteps);
  const CoefficientForcing forcing(problem, problem.model(), {}, {repulsion});
  const Vec direction = problem::project(*space, testing::random_vector(space->nodes(), 5));
  Columns S(space->nodes(), 2);
  S << direction, Vec::Zero(space->nodes());
  TangentFlow flow(problem, backends::choose_linear_solver("direct", *space).primary,
                   std::make_shared<ThreadTeam>(2));
  flow.advance(path.paths.front(), S, [&](double t, VecView y) { return forcing(t, y); });
  const double step = 1e-3;
  const Vec by_state =
      (end(kStrength, c + step * direction) - end(kStrength, c - step * direction)) / (2 * step);
  const Vec by_strength = (end(kStrength + step, c) - end(kStrength - step, c)) / (2 * step);
  EXPECT_LT(base.field_norm(by_state - S.col(0)), 0.01 * base.field_norm(by_state));
  EXPECT_LT(base.field_norm(by_strength - S.col(1)), 0.01 * base.field_norm(by_strength));
}

class TangentOfEffect : public TangentFlowTest,
                        public ::testing::WithParamInterface<std::string> {};

TEST_P(TangentOfEffect, IsTheDerivativeOfTheForecast) {
  const Candidate candidate = find_candidate(GetParam()).value();
  const CoefficientForcing forcing(base, base.model(), {}, {candidate});
  const Columns slopes = derivative(Columns::Zero(space->nodes(), candidate.directions),
                                    [&](double t, VecView y) { return forcing(t, y); });
  for (int d = 0; d < candidate.directions; ++d) {
    const Vec slope = slopes.col(d);
    // Small enough that the floor of the mobility, where it is not smooth, does not matter.
    const double step = 0.005 / base.field_norm(slope);
    expect_slope_two(
        [&](double size) {
          std::vector<double> a(candidate.directions, 0.0);
          a[d] = size;
          const problem::CahnHilliard changed(
              space, effects::with_effects(base.model(), {candidate.term(a)}));
          return advance(changed, c, kBegin, kEnd, 1).end;
        },
        slope, step);
  }
}

// Forecasts do not change with the variance of a random effect.
TEST_F(TangentFlowTest, RandomEffectsForceNothing) {
  const Candidate candidate = find_candidate("brownian-flow").value();
  const CoefficientForcing forcing(base, base.model(), {}, {candidate});
  const Columns slope = derivative(Columns::Zero(space->nodes(), 1),
                                   [&](double t, VecView y) { return forcing(t, y); });
  EXPECT_EQ(slope.norm(), 0);
}

// All that a sphere shows in the mean.
std::vector<std::string> effects_on_forecasts() {
  std::vector<std::string> names = selection::effects_to_hide();
  const auto random = [](const std::string& name) { return find_candidate(name)->random; };
  names.erase(std::remove_if(names.begin(), names.end(), random), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Effects, TangentOfEffect, ::testing::ValuesIn(effects_on_forecasts()),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& letter : name)
                             if (letter == '-') letter = '_';
                           return name;
                         });

}  // namespace
}  // namespace traceraft::assimilation
