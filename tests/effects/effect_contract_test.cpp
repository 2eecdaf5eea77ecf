// The promises of every effect (kernel/problem/effect.hpp, kernel/effects/effects.hpp).
#include <gtest/gtest.h>

#include "kernel/effects/effects.hpp"
#include "tests/support/spaces.hpp"
#include "tests/support/strong_effects.hpp"

namespace traceraft::effects {
namespace {

using testing::kStrong;
using testing::make_model;
using testing::make_space;
using testing::random_state;
using testing::random_vector;

constexpr physics::Units kScaled{1, 1, true};
constexpr double kTime = 0.37;

std::string name_of(const std::string& specification) {
  return split_named_arguments(specification).name;
}

class EffectContract : public ::testing::TestWithParam<std::string> {
 protected:
  EffectContract() : space(make_space(12, "ellipsoid:a=1.1,b=1,c=0.8")), base(space, make_model()) {
    problem::CahnHilliardModel model = make_model();
    add_effects(GetParam(), kScaled, model);
    problem = std::make_unique<problem::CahnHilliard>(space, model);
  }
  const EffectEntry& entry() const { return effects().find(name_of(GetParam())); }

  std::shared_ptr<const fem::SurfaceSpace> space;
  problem::CahnHilliard base;
  std::unique_ptr<problem::CahnHilliard> problem;
};

TEST_P(EffectContract, IsSeenInTheResidual) {
  const Vec y = random_state(*problem, 1), ydot = random_vector(problem->size(), 2);
  Vec with(problem->size()), without(problem->size());
  ASSERT_TRUE(problem->residual(kTime, y, ydot, with).ok());
  ASSERT_TRUE(base.residual(kTime, y, ydot, without).ok());
  EXPECT_GT((with - without).norm(), 1e-4 * without.norm());
}

// Strengths that may be negative have words for that.
TEST_P(EffectContract, SaysWhatANegativeStrengthMeans) {
  EXPECT_EQ(entry().parameters.front().min < 0, !entry().reversed.empty());
  std::vector<double> values(entry().parameters.size());
  values.front() = 1;
  EXPECT_EQ(physics_of({entry().name, values}), entry().summary);
  values.front() = -1;
  EXPECT_EQ(physics_of({entry().name, values}),
            entry().reversed.empty() ? entry().summary : entry().reversed);
}

// A model is what it has, not the order in which that was said.
TEST_P(EffectContract, CommutesWithTheOthers) {
  const Vec y = random_state(*problem, 1), still = Vec::Zero(problem->size());
  const std::string one = GetParam();
  const auto residual_of = [&](const std::string& specification) {
    problem::CahnHilliardModel model = make_model();
    add_effects(specification, kScaled, model);
    Vec r(problem->size());
    EXPECT_TRUE(problem::CahnHilliard(space, model).residual(kTime, y, still, r).ok());
    return r;
  };
  for (const std::string& other : kStrong) {
    if (name_of(other) == name_of(one)) continue;
    const Vec r = residual_of(one + ";" + other);
    EXPECT_LT((residual_of(other + ";" + one) - r).norm(), 1e-12 * r.norm()) << other;
  }
}

TEST_P(EffectContract, TangentIsTheDerivativeOfTheResidual) {
  const double shift = 2.1, step = 1e-6;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    // Within the wells, and not too near: powers have large derivatives there.
    Vec y = random_state(*problem, seed);
    y.head(problem->block_size()) = random_vector(problem->block_size(), seed, 0.1, 0.9);
    const Vec ydot = random_vector(problem->size(), seed + 50),
              v = random_vector(problem->size(), seed + 90);
    const auto residual_at = [&](double s) {
      Vec r(problem->size());
      EXPECT_TRUE(problem->residual(kTime, y + s * v, ydot + s * shift * v, r).ok());
      return r;
    };
    Vec product(problem->size());
    ASSERT_TRUE(
        problem->jacobian_product(kTime, y, ydot, shift, linear::Tangent::exact, v, product).ok());
    const Vec difference = (residual_at(step) - residual_at(-step)) / (2 * step);
    EXPECT_LT((product - difference).norm(), 2e-6 * product.norm()) << "seed " << seed;
  }
}

TEST_P(EffectContract, AssembledTangentIsAllOfItIfItSaysSo) {
  const Vec y = random_state(*problem, 7), ydot = random_vector(problem->size(), 8),
            v = random_vector(problem->size(), 9);
  linear::BlockJacobian J = problem->make_jacobian();
  ASSERT_TRUE(problem->jacobian(kTime, y, ydot, 1.3, linear::Tangent::exact, J).ok());
  Vec assembled(problem->size()), direct(problem->size());
  J.multiply(v, assembled, *space->team);
  ASSERT_TRUE(
      problem->jacobian_product(kTime, y, ydot, 1.3, linear::Tangent::exact, v, direct).ok());
  bool all = true;
  for (const problem::EffectPtr& effect : problem->model().effects)
    all = all && effect->tangent_is_assembled();
  EXPECT_EQ((assembled - direct).norm() < 1e-12 * direct.norm(), all);
}

TEST_P(EffectContract, StabilisedTangentAndItsProductAreOneButForWhatCouplesDistantPoints) {
  const Vec y = random_state(*problem, 7), ydot = random_vector(problem->size(), 8),
            v = random_vector(problem->size(), 9);
  linear::BlockJacobian J = problem->make_jacobian();
  ASSERT_TRUE(problem->jacobian(kTime, y, ydot, 1.3, linear::Tangent::stabilised, J).ok());
  Vec assembled(problem->size()), direct(problem->size());
  J.multiply(v, assembled, *space->team);
  ASSERT_TRUE(
      problem->jacobian_product(kTime, y, ydot, 1.3, linear::Tangent::stabilised, v, direct).ok());
  // What couples distant points is in the product alone, and takes energy as a mobility does.
  const auto n = problem->block_size();
  const Vec rest = direct - assembled;
  bool all = true;
  for (const problem::EffectPtr& effect : problem->model().effects)
    all = all && effect->tangent_is_assembled();
  if (all) {
    EXPECT_LT(rest.norm(), 1e-12 * direct.norm());
  }
  EXPECT_GE(v.tail(n).dot(rest.head(n)), -1e-12 * direct.norm() * v.norm());
  EXPECT_LT(rest.tail(n).norm(), 1e-12 * direct.norm());
}

TEST_P(EffectContract, KeepsMassExactlyIfItSaysSo) {
  EXPECT_EQ(problem->conserves_mass(), entry().mass == MassClass::conserves);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Vec y = random_state(*problem, seed);
    Vec r(problem->size());
    ASSERT_TRUE(problem->residual(kTime, y, Vec::Zero(problem->size()), r).ok());
    const auto first = r.head(problem->block_size());
    EXPECT_EQ(std::fabs(first.sum()) < 1e-14 * first.cwiseAbs().sum(), problem->conserves_mass());
  }
}

// dE/dt along ċ from a consistent state is minus the dissipation μᵀ F1(μ, ċ = 0), which is not
// negative.
TEST_P(EffectContract, DissipatesEnergyIfItSaysSo) {
  const bool first_strength =
      GetParam().find(":" + entry().parameters.front().name + "=") != std::string::npos;
  EXPECT_EQ(problem->dissipates_energy(),
            first_strength && entry().energy == EnergyClass::dissipates);
  if (!problem->dissipates_energy()) return;
  const int n = problem->block_size();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Vec y = random_state(*problem, seed), ydot(problem->size()), flux(2 * n);
    ASSERT_TRUE(problem->consistent_initial_state(0, y, ydot).ok());
    ASSERT_TRUE(problem->residual(0, y, Vec::Zero(2 * n), flux).ok());
    const double dissipation = y.tail(n).dot(flux.head(n));
    EXPECT_GE(dissipation, 0);
    const double step = 1e-7 * y.head(n).norm() / ydot.head(n).norm();
    const Vec forth = y + step * ydot, back = y - step * ydot;
    const double rate = (problem->energy(forth) - problem->energy(back)) / (2 * step);
    EXPECT_NEAR(rate / dissipation, -1, 1e-3);
  }
}

// Each is called after its effect and the strength that it has.
INSTANTIATE_TEST_SUITE_P(All, EffectContract, ::testing::ValuesIn(kStrong), [](const auto& info) {
  std::string name = info.param.substr(0, info.param.find('='));
  for (char& ch : name)
    if (ch == '-' || ch == ':') ch = '_';
  return name;
});

std::vector<std::string> strong_names() {
  std::vector<std::string> names;
  for (const std::string& one : kStrong)
    if (names.empty() || names.back() != name_of(one)) names.push_back(name_of(one));
  return names;
}

TEST(Effects, AllAreTestedAndNameEachOther) {
  EXPECT_EQ(effects().names(), strong_names());
  for (const EffectEntry& entry : effects()) {
    EXPECT_EQ(entry.parameters.front().default_value, 0) << entry.name;
    for (const std::string& other : entry.confused_with)
      EXPECT_NO_THROW((void)effects().find(other)) << entry.name;
  }
}

TEST(Effects, SayWhatIsWrong) {
  problem::CahnHilliardModel model = make_model();
  const auto complaint = [&](const std::string& text) -> std::string {
    try {
      add_effects(text, kScaled, model);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(complaint("exchang:rate=1").find("did you mean 'exchange'"), std::string::npos);
  EXPECT_NE(complaint("exchange:rat=1").find("rate"), std::string::npos);
  EXPECT_NE(complaint("exchange:rate=-1").find("out of range"), std::string::npos);
  EXPECT_NE(complaint("exchange").find("exchange:rate=..."), std::string::npos);
  EXPECT_NE(complaint("rotation:rate=1,x=0,y=0,z=0").find("axis"), std::string::npos);
  EXPECT_NE(
      complaint("gravity:strength=1; exchange:rate=1; gravity:strength=2").find("given twice"),
      std::string::npos);
  EXPECT_EQ(complaint(" ; gravity:strength=1 ;exchange:rate=1"), "");
  EXPECT_EQ(model.effects.size(), 2u);
}

TEST(Effects, RefuseWellsTheyAreNotMadeFor) {
  problem::CahnHilliardModel model = make_model();
  model.well = {1, 0.3, 0.7};
  EXPECT_NO_THROW(add_effects("exchange:rate=1; gravity:strength=1", kScaled, model));
  for (const char* effect : {"asymmetry:strength=0.1", "cooling:rate=1", "uptake:rate=1",
                             "mobility-contrast:strength=1", "mobility-exponent:excess=1"})
    EXPECT_THROW(add_effects(effect, kScaled, model), InputError) << effect;
}

TEST(Effects, AreTheSameInAnyOrder) {
  const auto space = make_space(10);
  const auto residual = [&](const std::string& text) {
    problem::CahnHilliardModel model = make_model();
    add_effects(text, kScaled, model);
    const problem::CahnHilliard problem(space, model);
    Vec r(problem.size());
    const Status status =
        problem.residual(0.7, random_state(problem, 4), random_vector(problem.size(), 5), r);
    EXPECT_TRUE(status.ok()) << status.why;
    return r;
  };
  const std::string cooling = "cooling:rate=1", thermal = "thermal:strength=1e-3,time=0.1";
  for (const char* mobility : {"mobility-contrast:strength=0.5", "mobility-exponent:excess=1"})
    for (const std::string& other : {cooling, thermal})
      EXPECT_EQ(residual(other + ";" + mobility), residual(mobility + (";" + other)));
}

// The line tension that is given to a flow is that of the model without the effect.
TEST(Effects, FlowDoesNotDependOnWhereLineTensionStands) {
  const auto space = make_space(10);
  const physics::Units units{5, 1e-5, false};
  const auto residual = [&](const std::string& text) {
    problem::CahnHilliardModel model = make_model();
    add_effects(text, units, model);
    const problem::CahnHilliard problem(space, model);
    Vec r(problem.size());
    EXPECT_TRUE(problem.residual(0.7, random_state(problem, 4), Vec::Zero(problem.size()), r).ok());
    return r;
  };
  const std::string tension = "line-tension:excess=3",
                    flow = "flow:membrane-viscosity=4,line-tension=100,temperature=298";
  EXPECT_EQ(residual(tension + ";" + flow), residual(flow + ";" + tension));
}

TEST(Effects, TakeTheirParametersInPhysicalUnits) {
  const physics::Units units{5, 1e-5, false};  // R²/D = 0.025 s
  problem::CahnHilliardModel physical = make_model(), scaled = make_model();
  add_effects("exchange:rate=40; ohta-kawasaki:strength=1,range=2.5", units, physical);
  add_effects("exchange:rate=1; ohta-kawasaki:strength=1,range=0.5", kScaled, scaled);
  const auto space = make_space(10);
  const problem::CahnHilliard one(space, physical), other(space, scaled);
  const Vec y = random_state(one, 4), ydot = random_vector(one.size(), 5);
  Vec r(one.size()), s(one.size());
  ASSERT_TRUE(one.residual(0, y, ydot, r).ok());
  ASSERT_TRUE(other.residual(0, y, ydot, s).ok());
  EXPECT_LT((r - s).norm(), 1e-12 * s.norm());
}

// Values that are not given are in µm and s, whatever the units of those that are.
TEST(Effects, HaveTheSameDefaultsInAnyUnits) {
  const auto space = make_space(10);
  const auto residual = [&](const std::string& effect, bool scaled) {
    problem::CahnHilliardModel model = make_model();
    add_effects(effect, {5, 1e-5, scaled}, model);
    const problem::CahnHilliard problem(space, model);
    Vec r(problem.size());
    EXPECT_TRUE(problem.residual(0.7, random_state(problem, 4), Vec::Zero(problem.size()), r).ok());
    return r;
  };
  for (const char* effect : {"ohta-kawasaki:strength=1", "thermal:strength=0.01"}) {
    const Vec physical = residual(effect, false);
    EXPECT_LT((residual(effect, true) - physical).norm(), 1e-12 * physical.norm()) << effect;
  }
}

TEST(Effects, RefuseSurfacesThatTheyAreNotMadeFor) {
  const auto complaint = [&](const std::string& effect, const std::string& surface) -> std::string {
    problem::CahnHilliardModel model = make_model();
    add_effects(effect, kScaled, model);
    try {
      for (const problem::EffectPtr& one : model.effects)
        one->require_surface(*make_space(32, surface));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  for (const char* surface : {"sphere", "torus", "ellipsoid:a=1.2,b=1.2,c=0.8"})
    EXPECT_EQ(complaint("rotation:rate=1", surface), "");
  EXPECT_EQ(complaint("rotation:rate=1,x=1,z=0", "ellipsoid:a=1.2,b=1,c=1"), "");
  for (const char* surface : {"ellipsoid:a=1.05,b=1,c=1", "ellipsoid", "dziuk"})
    EXPECT_NE(complaint("rotation:rate=1", surface).find("not symmetric around"), std::string::npos)
        << surface;
  EXPECT_NE(complaint("rotation:rate=1,x=1", "torus").find("not symmetric around"),
            std::string::npos);
  EXPECT_EQ(complaint("gravity:strength=1", "ellipsoid"), "");
}

}  // namespace
}  // namespace traceraft::effects
