#include <gtest/gtest.h>

#include "backends/list.hpp"
#include "kernel/core/error.hpp"
#include "kernel/effects/brownian_flow.hpp"
#include "kernel/effects/capillary_flow.hpp"
#include "kernel/effects/effects.hpp"
#include "kernel/problem/initial_data.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::effects {
namespace {

using testing::make_model;
using testing::make_space;
using testing::random_vector;

constexpr flow::FluidMembrane kMembrane{0, 0.8, 0.02};
constexpr double kHold = 0.05;

Vec residual_of(const problem::Effect& effect, const fem::SurfaceSpace& space, double t,
                const Vec& c, const Vec& mu) {
  Vec r = Vec::Zero(c.size()), other = r;
  effect.add_residual(space, t, c, mu, r, other);
  EXPECT_EQ(other.norm(), 0);
  return r;
}

// 4,000 draws of 2l + 1 numbers: the mean square is known to √(2/(4000 (2l + 1))), 1.3 % at most.
TEST(BrownianFlow, EveryModeHasTheVarianceThatFluctuationAndDissipationSay) {
  const auto space = make_space(12);
  const BrownianFlow flow(kMembrane, 0.05, kHold, 1);
  constexpr int kDraws = 4000, kDegree = 10;
  Vec squares = Vec::Zero(kDegree + 1);
  for (int k = 0; k < kDraws; ++k) {
    const Vec drawn = flow.draw(*space, k);
    ASSERT_EQ(drawn.size(), (kDegree + 1) * (kDegree + 1));
    for (int l = 0; l <= kDegree; ++l)
      squares[l] += drawn.segment(flow::harmonic_index(l, -l), 2 * l + 1).squaredNorm() / kDraws;
  }
  EXPECT_EQ(squares[0], 0);
  for (int l = 1; l <= kDegree; ++l) {
    const double friction = ((l - 1.0) * (l + 2) + 0.8 * (2 * l + 1)) * l * (l + 1);
    EXPECT_NEAR(squares[l] * friction * kHold / (2 * 0.02 * (2 * l + 1)), 1, 0.06) << l;
  }
}

TEST(BrownianFlow, DrawsDoNotDependOnTheHighestDegree) {
  const auto space = make_space(12);
  const auto drawn = [&](double epsilon, std::uint64_t seed, double number) {
    return BrownianFlow(kMembrane, epsilon, kHold, seed).draw(*space, number);
  };
  const Vec few = drawn(0.1, 3, 17), many = drawn(0.02, 3, 17);
  EXPECT_LT(few.size(), many.size());
  EXPECT_EQ(many.head(few.size()), few);
  EXPECT_NE(drawn(0.1, 4, 17), few);
  EXPECT_NE(drawn(0.1, 3, 18), few);
}

TEST(BrownianFlow, MovesNoConstantAndKeepsTheMass) {
  const auto space = make_space(12);
  const BrownianFlow flow(kMembrane, 0.1, kHold, 1);
  const Vec one = Vec::Ones(space->nodes()), c = random_vector(space->nodes(), 1);
  const Vec moved = residual_of(flow, *space, 0.33, c, c);
  EXPECT_GT(moved.norm(), 1e-3);
  EXPECT_LT(std::fabs(moved.sum()), 1e-14 * moved.lpNorm<1>());
  EXPECT_LT(residual_of(flow, *space, 0.33, one, c).norm(), 1e-13 * moved.norm());
}

// A draw is a sum of the noises, with normal numbers.
TEST(BrownianFlow, IsASumOfItsNoises) {
  const auto space = make_space(12);
  const BrownianFlow flow(kMembrane, 0.1, kHold, 1);
  const Vec c = random_vector(space->nodes(), 1);
  const Eigen::MatrixXd noises = flow.noises(*space, c);
  EXPECT_EQ(noises.cols(), 6 * 6 - 1);
  const auto factors = noises.colPivHouseholderQr();
  constexpr int kDraws = 20;
  double squares = 0;
  for (int k = 0; k < kDraws; ++k) {
    const Vec drawn = -std::sqrt(kHold) * residual_of(flow, *space, k * kHold, c, c),
              normal = factors.solve(drawn);
    EXPECT_LT((noises * normal - drawn).norm(), 1e-10 * drawn.norm());
    squares += normal.squaredNorm() / (kDraws * 35);
  }
  EXPECT_NEAR(squares, 1, 4 * std::sqrt(2.0 / (kDraws * 35)));
  EXPECT_LT(flow.noises(*space, Vec::Ones(c.size())).norm(), 1e-13 * noises.norm());
}

// A run that goes on asks for the same times in another order.
TEST(BrownianFlow, IsAFunctionOfTime) {
  const auto space = make_space(12);
  const BrownianFlow flow(kMembrane, 0.1, kHold, 1);
  const Vec c = random_vector(space->nodes(), 1);
  const Vec first = residual_of(flow, *space, 0.33, c, c);
  const Vec at_draw = residual_of(flow, *space, 7 * kHold, c, c);
  for (const double t : {0.1, 0.36, 0.31}) (void)residual_of(flow, *space, t, c, c);
  EXPECT_EQ(residual_of(flow, *space, 0.33, c, c), first);
  EXPECT_EQ(residual_of(BrownianFlow(kMembrane, 0.1, kHold, 1), *space, 0.33, c, c), first);
  const Vec near = residual_of(flow, *space, 7 * kHold - 1e-9, c, c);
  EXPECT_LT((near - at_draw).norm(), 1e-6 * at_draw.norm());
}

TEST(BrownianFlow, IsLinearInC) {
  const auto space = make_space(12);
  const BrownianFlow flow(kMembrane, 0.1, kHold, 1);
  const Vec c = random_vector(space->nodes(), 1), v = random_vector(space->nodes(), 2);
  Vec product = Vec::Zero(c.size()), other = product;
  flow.add_tangent_product(*space, 0.33, c, c, v, c, product, other);
  const Vec change =
      residual_of(flow, *space, 0.33, c + v, c) - residual_of(flow, *space, 0.33, c, c);
  EXPECT_LT((product - change).norm(), 1e-13 * change.norm());
}

// R = 5 µm and D = 1000 µm²/s; ε = 0.01 R; 4 nPa s m, 1 mPa s, 1 pN and 298 K.
TEST(Flow, FollowsFromViscositiesLineTensionAndTemperature) {
  const auto space = make_space(12);
  constexpr physics::Units kPhysical{5, 1e-5, false}, kScaled{5, 1e-5, true};
  const auto model_of = [&](const std::string& specification, const physics::Units& units) {
    problem::CahnHilliardModel model = make_model();
    model.epsilon = 0.01;
    add_effects(specification, units, model);
    return model;
  };
  const auto physical =
      model_of("flow:membrane-viscosity=4,line-tension=1,temperature=298,hold=0.0005", kPhysical);
  const auto scaled =
      model_of("flow:capillary=1060.66017,water=1.25,thermal=1.028584e-3,hold=0.02", kScaled);
  ASSERT_EQ(physical.effects.size(), 2u);
  ASSERT_EQ(scaled.effects.size(), 2u);
  const Vec c = random_vector(space->nodes(), 1), mu = random_vector(space->nodes(), 2);
  // A well whose boundaries are half as wide and pull twice as much.
  problem::CahnHilliardModel steep = make_model();
  steep.epsilon = 0.01;
  steep.well.rho = 1;
  add_effects("flow:membrane-viscosity=4,line-tension=2", kPhysical, steep);
  const Vec mu_0 = random_vector(space->nodes(), 2), c_0 = random_vector(space->nodes(), 1);
  const Vec usual = residual_of(*physical.effects[0], *space, 0.33, c_0, mu_0);
  EXPECT_LT((residual_of(*steep.effects[0], *space, 0.33, c_0, mu_0) - usual).norm(),
            1e-6 * usual.norm());
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec a = residual_of(*physical.effects[k], *space, 0.33, c, mu),
              b = residual_of(*scaled.effects[k], *space, 0.33, c, mu);
    EXPECT_LT((a - b).norm(), 1e-6 * b.norm()) << k;
  }
}

// From noise, whose steep gradients are moved by waves that grow if a step extrapolates them.
TEST(Flow, FromNoiseLosesEnergyWithEveryIntegrator) {
  const auto space = make_space(16);
  problem::CahnHilliardModel model = make_model();
  model.epsilon = 0.15;
  add_effects("flow:capillary=1e5", {1, 1, true}, model);
  const problem::CahnHilliard problem(space, model);
  Vec y = Vec::Zero(problem.size()), ydot = y;
  problem::InitialRequest request;
  request.raft_fraction = 0.4;
  y.head(problem.block_size()) = problem::make_initial_field("noise", *space, request);
  ASSERT_TRUE(problem.consistent_initial_state(0, y, ydot).ok());
  const double initial = problem.energy(y);
  std::vector<double> ends;
  for (const char* name : {"ida", "euler", "rosenbrock"}) {
    time::IntegratorSettings settings;
    settings.tolerance = backends::integrators().find(name).tolerance;
    const time::IntegratorPtr integrator = backends::integrators().find(name).make(
        problem, backends::choose_linear_solver("block", *space), space->team, settings);
    ASSERT_TRUE(integrator->start(0, y, ydot, 0.003).ok());
    double energy = initial;
    while (integrator->time() < 0.003) {
      const Status status = integrator->advance();
      ASSERT_TRUE(status.ok()) << name << ": " << status.why;
      const double next = problem.energy(integrator->state());
      EXPECT_LT(next, energy + 1e-3 * initial) << name;
      energy = next;
    }
    ends.push_back(energy);
  }
  EXPECT_LT(ends[0], 0.5 * initial);
  for (const double end : ends) EXPECT_NEAR(end, ends[0], 0.1 * ends[0]);
}

TEST(Flow, IsTwoEffectsByTheirNumbers) {
  const std::vector<EffectTerm> both = read_effects(
      "flow:membrane-viscosity=4,line-tension=1,temperature=298,hold=2", physics::Units{5, 1e-5});
  const std::vector<EffectTerm> singles = in_single_strengths(both.front(), 0.01, {});
  ASSERT_EQ(singles.size(), 2U);
  problem::CahnHilliardModel model = make_model();
  model.epsilon = 0.01;
  const auto space = make_space(12);
  const Vec c = random_vector(space->nodes(), 1), mu = random_vector(space->nodes(), 2);
  const auto rates = [&](const std::vector<EffectTerm>& terms) {
    Vec sum = Vec::Zero(c.size());
    for (const problem::EffectPtr& effect : with_effects(model, terms).effects)
      sum += residual_of(*effect, *space, 0.3, c, mu);
    return sum;
  };
  EXPECT_LT((rates(singles) - rates(both)).norm(), 1e-12 * rates(both).norm());
  for (const EffectTerm& single : singles)
    EXPECT_EQ(with_effects(model, {single}).effects.size(), 1U);
  const EffectTerm other{"gravity", {0.3}};
  EXPECT_EQ(in_single_strengths(other, 0.01, {}).front().values, other.values);
}

TEST(Flow, ShowsTheNumbersThatCount) {
  const auto used = [](const std::string& text) {
    const EffectTerm term = read_effects(text, physics::Units{5, 1e-5}).front();
    std::vector<std::string> names;
    for (std::size_t k = 0; k < term.values.size(); ++k)
      if (is_used(term, k)) names.push_back(effects().find("flow").parameters[k].name);
    return names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(used("flow:capillary=3"), (Names{"capillary", "water"}));
  EXPECT_EQ(used("flow:thermal=3"), (Names{"thermal", "water", "seed"}));
  EXPECT_EQ(used("flow:membrane-viscosity=3,temperature=298,hold=1"),
            (Names{"membrane-viscosity", "temperature", "water-viscosity", "hold", "seed"}));
}

TEST(Flow, RefusesWhatContradictsItself) {
  problem::CahnHilliardModel model = make_model();
  constexpr physics::Units kPhysical{5, 1e-5, false}, kScaled{5, 1e-5, true};
  for (const char* bad :
       {"flow:water=1", "flow:line-tension=1", "flow:membrane-viscosity=4",
        "flow:membrane-viscosity=4,capillary=1", "flow:capillary=1,temperature=300",
        "flow:membrane-viscosity=4,line-tension=1,water=2", "flow:capillary=1,water-viscosity=2",
        "flow:capillary=1,hold=4", "flow:membrane-viscosity=4,temperature=25"})
    EXPECT_THROW(add_effects(bad, kPhysical, model), InputError) << bad;
  EXPECT_THROW(add_effects("flow:membrane-viscosity=4,line-tension=1", kScaled, model), InputError);
  EXPECT_NO_THROW(add_effects("flow:thermal=1e-3", kScaled, model));
  const auto torus = make_space(24, "torus");
  EXPECT_THROW(model.effects.front()->require_surface(*torus), InputError);
}

}  // namespace
}  // namespace traceraft::effects
