// The physics of effects, against exact answers.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/effects/effects.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::effects {
namespace {

using testing::make_model;
using testing::make_space;
using testing::random_state;
using testing::random_vector;

constexpr physics::Units kUnits{1, 1, true};

problem::CahnHilliardModel model_with(const std::string& effect) {
  problem::CahnHilliardModel model = make_model();
  add_effects(effect, kUnits, model);
  return model;
}

// F with the model's effects minus F without them.
Vec contribution(const std::shared_ptr<const fem::SurfaceSpace>& space,
                 const problem::CahnHilliardModel& model, const Vec& y, double t = 0) {
  const problem::CahnHilliard base(space, make_model()), problem(space, model);
  const Vec still = Vec::Zero(y.size());
  Vec with(y.size()), without(y.size());
  EXPECT_TRUE(problem.residual(t, y, still, with).ok());
  EXPECT_TRUE(base.residual(t, y, still, without).ok());
  return with - without;
}

Vec contribution(const std::shared_ptr<const fem::SurfaceSpace>& space, const std::string& effect,
                 const Vec& y, double t = 0) {
  return contribution(space, model_with(effect), y, t);
}

class EffectPhysics : public ::testing::Test {
 protected:
  EffectPhysics()
      : space(make_space(16)), n(space->nodes()), y(random_vector(2 * n, 3, 0.1, 0.9)) {}
  double mean_rate(const std::string& effect, double t = 0) const {
    return -contribution(space, effect, y, t).head(n).sum();
  }
  // A nodal field.
  template <class Function>
  Vec nodal(const Function& f) const {
    Vec values(n);
    for (int i = 0; i < n; ++i) values[i] = f(space->mesh.position(i));
    return values;
  }
  const std::shared_ptr<const fem::SurfaceSpace> space;
  const int n;
  Vec y;
};

TEST_F(EffectPhysics, SourcesChangeTheMassAsTheySay) {
  const double mass = space->integral(y.head(n)), area = space->area;
  EXPECT_NEAR(mean_rate("exchange:rate=2,target=0.3"), -2 * (mass - 0.3 * area), 1e-10);
  EXPECT_NEAR(mean_rate("uptake:rate=2"), 2 * (area - mass), 1e-10);
  EXPECT_NEAR(mean_rate("allen-cahn:rate=2"), -2 * space->integral(y.tail(n)), 1e-10);
  EXPECT_NEAR(mean_rate("cooling:rate=2,out=0.1,in=0.05,activation=0"),
              2 * (0.1 * (area - mass) - 0.05 * mass), 1e-10);
}

// Not on average only.
TEST_F(EffectPhysics, SourcesActWhereTheyAre) {
  const Vec v = nodal([](const Point& p) { return p[0] + 0.5 * p[1] * p[2]; });
  const double c = space->inner(y.head(n), v), mu = space->inner(y.tail(n), v),
               one = space->integral(v);
  const auto rate = [&](const std::string& effect) {
    return -contribution(space, effect, y).head(n).dot(v);
  };
  EXPECT_NEAR(rate("exchange:rate=2,target=0.3"), -2 * (c - 0.3 * one), 1e-10);
  EXPECT_NEAR(rate("uptake:rate=2"), 2 * (one - c), 1e-10);
  EXPECT_NEAR(rate("allen-cahn:rate=2"), -2 * mu, 1e-10);
  EXPECT_NEAR(rate("cooling:rate=2,out=0.1,in=0.05,activation=0"), 2 * (0.1 * (one - c) - 0.05 * c),
              1e-10);
}

TEST_F(EffectPhysics, AsymmetryAddsTheSlopeOfItsEnergy) {
  const auto g = [](double c) {
    const double side = c < 0 ? -1 : c > 1 ? 1 : 2 * c - 1;
    return c * c * (1 - c) * (1 - c) * side;
  };
  for (const double c : {-0.1, 0.2, 0.3, 0.5, 0.9, 1.1}) {
    const Vec uniform = Vec::Constant(2 * n, c);
    const double slope = (g(c + 1e-6) - g(c - 1e-6)) / 2e-6;
    EXPECT_NEAR(contribution(space, "asymmetry:strength=0.15", uniform).tail(n).sum(),
                -0.15 * slope * space->area, 1e-8)
        << c;
  }
}

TEST_F(EffectPhysics, CoolingSlowsDiffusionDown) {
  const problem::CahnHilliard base(space, make_model());
  Vec flux(2 * n);
  ASSERT_TRUE(base.residual(0, y, Vec::Zero(2 * n), flux).ok());
  space->normal_stiffness.multiply_add(-space->h(), y.tail(n), flux.head(n), *space->team);
  const Vec change =
      contribution(space, "cooling:rate=1,out=0,in=0,activation=0.5", y, std::log(4.0));
  EXPECT_LT((change.head(n) + 0.5 * flux.head(n)).norm(), 1e-12 * flux.head(n).norm());
}

TEST_F(EffectPhysics, RotationTurnsFieldsAround) {
  // d/dt ∫ c y = ω ∫ c x about the z axis, but for the part of ω × x across the flat triangles.
  const double tolerance = space->h() * space->h() * 0.05;
  const Vec change = contribution(space, "rotation:rate=1.5", y);
  const Vec x = nodal([](const Point&p) { return p[0]; }),
            other = nodal([](const Point&p) { return p[1]; });
  EXPECT_NEAR(-change.head(n).dot(other), 1.5 * space->inner(y.head(n), x), tolerance);
  EXPECT_NEAR(-change.head(n).dot(x), -1.5 * space->inner(y.head(n), other), tolerance);
}

TEST_F(EffectPhysics, GravityPullsAlongZ) {
  const Vec change = contribution(space, "gravity:strength=3", y);
  const Vec z = nodal([](const Point& p) { return p[2]; });
  EXPECT_NEAR(change.tail(n).dot(z), -3 * space->inner(z, z), 1e-10);
}

TEST_F(EffectPhysics, OhtaKawasakiSolvesItsEquation) {
  // c = z: φ = z/(κ² + 2).
  const auto fine = make_space(48);
  const int nodes = fine->nodes();
  Vec state = Vec::Zero(2 * nodes), z(nodes);
  for (int i = 0; i < nodes; ++i) z[i] = fine->mesh.position(i).normalized()[2];
  state.head(nodes) = z.array() + 0.4;
  for (const auto& [range, rate] :
       {std::pair("0.5", 4.0 + 2), {"1e3", 1e-6 + 2}, {"1e6", 1e-12 + 2}}) {
    const Vec change =
        contribution(fine, std::string("ohta-kawasaki:strength=3,range=") + range, state);
    EXPECT_NEAR(change.tail(nodes).dot(z) / (-3 * fine->inner(z, z) / rate), 1, 2e-3);
    EXPECT_NEAR(change.tail(nodes).sum(), 0, 1e-11);  // its mean is 0
  }
}

// One model serves several meshes, and outlives them.
TEST_F(EffectPhysics, OhtaKawasakiKnowsOnWhichMeshItIs) {
  const std::string effect = "ohta-kawasaki:strength=3,range=0.5";
  const problem::CahnHilliardModel shared = model_with(effect);
  const auto check_on = [&](const std::shared_ptr<const fem::SurfaceSpace>& mesh) {
    const Vec state = random_vector(2 * mesh->nodes(), 5, 0.1, 0.9);
    EXPECT_EQ((contribution(mesh, shared, state) - contribution(mesh, effect, state))
                  .lpNorm<Eigen::Infinity>(),
              0);
  };
  const auto coarse = make_space(12);
  for (const auto& mesh : {coarse, space, coarse}) check_on(mesh);
  for (const std::int64_t cells : {12, 14, 16}) check_on(make_space(cells));
}

TEST_F(EffectPhysics, CurvatureIsThatOfTheSurface) {
  // The mean curvature H of an ellipsoid of revolution with half axes 1 and c: at the poles c (both
  // principal curvatures are c/1), at the equator (1 + 1/c²)/2.
  const double c = 0.7;
  const auto ellipsoid = make_space(64, "ellipsoid:a=1,b=1,c=0.7");
  const int nodes = ellipsoid->nodes();
  const Vec change =
      contribution(ellipsoid, "curvature:strength=1", Vec::Zero(2 * nodes)).tail(nodes);
  Vec curvature(nodes);
  ASSERT_TRUE(ellipsoid->solve_mass(change, curvature).ok());
  double pole = 0, equator = 0;
  int at_pole = 0, at_equator = 0;
  for (int i = 0; i < nodes; ++i) {
    const Point x = ellipsoid->mesh.position(i);
    if (std::hypot(x[0], x[1]) < 0.15) pole += curvature[i], ++at_pole;
    if (std::fabs(x[2]) < 0.08) equator += curvature[i], ++at_equator;
  }
  EXPECT_NEAR(pole / at_pole, c, 0.03);
  EXPECT_NEAR(equator / at_equator, 0.5 * (1 + 1 / (c * c)), 0.05);
}

// H = (1/r + cos θ/(R + r cos θ))/2 on a torus, negative nowhere here, though its inner side points
// to the centre.
TEST_F(EffectPhysics, CurvatureOfATorusHasTheRightSign) {
  const auto torus = make_space(64, "torus:major=1,minor=0.4");
  const int nodes = torus->nodes();
  const Vec change = contribution(torus, "curvature:strength=1", Vec::Zero(2 * nodes)).tail(nodes);
  // Means over two rings: ∫ H φ_i over ∫ φ_i.
  double inner = 0, outer = 0, inner_area = 0, outer_area = 0;
  for (int i = 0; i < nodes; ++i) {
    const Point x = torus->mesh.position(i);
    if (std::fabs(x[2]) > 0.06) continue;
    const bool is_inner = std::hypot(x[0], x[1]) < 1;
    (is_inner ? inner : outer) += change[i];
    (is_inner ? inner_area : outer_area) += torus->node_area[i];
  }
  EXPECT_NEAR(inner / inner_area, 0.5 * (2.5 - 1 / 0.6), 0.02);
  EXPECT_NEAR(outer / outer_area, 0.5 * (2.5 + 1 / 1.4), 0.02);
}

TEST_F(EffectPhysics, MobilitiesAreTheLawsTheySay) {
  const double c[3] = {0.2, 0.5, 0.9};
  double value[3], derivative[3];
  problem::CahnHilliardModel model = make_model();
  add_effects("mobility-contrast:strength=0.4", kUnits, model);
  model.mobility->evaluate(c, 3, value, derivative);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(value[i], c[i] * (1 - c[i]) * (1 + 0.4 * (2 * c[i] - 1)), 1e-14);
  model = make_model();
  add_effects("mobility-exponent:excess=0.5", kUnits, model);
  model.mobility->evaluate(c, 3, value, derivative);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(value[i], 2 * std::pow(c[i] * (1 - c[i]), 1.5), 1e-14);
  // More than one of them: each of the law that those before it leave.
  model = make_model();
  add_effects(
      "bulk-mobility:strength=0.3;mobility-exponent:excess=0.5;"
      "mobility-contrast:strength=0.4",
      kUnits, model);
  model.mobility->evaluate(c, 3, value, derivative);
  for (int i = 0; i < 3; ++i) {
    const double s = c[i] * (1 - c[i]);
    EXPECT_NEAR(value[i], 2 * std::sqrt(s) * s * (1 + 0.4 * (2 * c[i] - 1)) + 0.3, 1e-14);
  }
  // A constant added to a constant law is that of a larger one.
  problem::CahnHilliardModel sum = make_model("constant:value=0.2"),
                             whole = make_model("constant:value=0.5");
  add_effects("bulk-mobility:strength=0.3", kUnits, sum);
  const problem::CahnHilliard one(space, sum), other(space, whole);
  Vec r(2 * n), s(2 * n);
  ASSERT_TRUE(one.residual(0, y, Vec::Zero(2 * n), r).ok());
  ASSERT_TRUE(other.residual(0, y, Vec::Zero(2 * n), s).ok());
  const Vec mu = y.tail(n);
  Vec stabilisation = Vec::Zero(n);  // which knows the scale of the law
  space->normal_stiffness.multiply_add(
      (whole.mobility->scale() - sum.mobility->scale()) * space->h(), mu, stabilisation,
      *space->team);
  EXPECT_LT((s.head(n) - r.head(n) - stabilisation).norm(), 1e-12 * s.norm());
}

// A falling temperature slows all diffusion down.
TEST_F(EffectPhysics, CoolingSlowsDownWhateverTheMobilityIs) {
  const std::string slower = "cooling:rate=2,out=0,in=0,activation=0.3";
  const double t = 0.7, factor = std::exp(-0.3 * 2 * t);
  const auto flux = [&](const std::string& effects) {
    problem::CahnHilliardModel model = make_model();
    model.stabilisation = 0;
    add_effects(effects, kUnits, model);
    Vec r(2 * n);
    EXPECT_TRUE(problem::CahnHilliard(space, model).residual(t, y, Vec::Zero(2 * n), r).ok());
    return Vec(r.head(n));
  };
  const Vec still = flux("bulk-mobility:strength=0.3");
  EXPECT_LT((flux("bulk-mobility:strength=0.3;" + slower) - factor * still).norm(),
            1e-10 * still.norm());
}

TEST_F(EffectPhysics, LineTensionIsThatOfALargerEpsilon) {
  problem::CahnHilliardModel model = make_model();
  add_effects("line-tension:excess=0.44", kUnits, model);
  EXPECT_DOUBLE_EQ(model.epsilon, 1.2 * make_model().epsilon);
}

// Fluctuation and dissipation: along any v the noise has the variance 2 kT vᵀ K_M v/τ at the times
// at which it is drawn, and none of the mean; along directions that K_M does not couple it is
// independent.
TEST_F(EffectPhysics, ThermalNoiseHasTheVarianceOfItsDissipation) {
  constexpr int kDirections = 40, kDraws = 100;
  constexpr double kVariance = 2 * 0.01 / 0.25;
  const problem::CahnHilliard base(space, make_model());
  const auto dissipation = [&](const Vec& v) {
    Vec flux = y, response(2 * n);
    flux.tail(n) = v;
    EXPECT_TRUE(base.residual(0, flux, Vec::Zero(2 * n), response).ok());
    space->normal_stiffness.multiply_add(-space->h(), v, response.head(n), *space->team);
    return Vec(response.head(n));
  };
  Eigen::MatrixXd directions(n, kDirections);  // vᵀ K_M v = 1, and 0 of two of them
  for (int k = 0; k < kDirections; ++k) {
    Vec v = random_vector(n, 100 + static_cast<std::uint64_t>(k));
    const Vec coupled = directions.leftCols(k).transpose() * dissipation(v);
    v -= directions.leftCols(k) * coupled;
    directions.col(k) = v / std::sqrt(v.dot(dissipation(v)));
  }
  double sum = 0, squares = 0;
  for (int k = 0; k < kDraws; ++k) {
    const Vec noise =
        directions.transpose() *
        contribution(space, "thermal:strength=0.01,time=0.25,seed=9", y, 0.25 * k).head(n);
    sum += noise.sum();
    squares += noise.squaredNorm();
  }
  constexpr double kCount = kDirections * kDraws;
  EXPECT_NEAR(squares / kCount / kVariance, 1, 4 * std::sqrt(2 / kCount));  // 9 %
  EXPECT_LT(std::fabs(sum / kCount), 4 * std::sqrt(kVariance / kCount));
}

TEST_F(EffectPhysics, ThermalNoiseIsAsMuchSlowerAsItsDissipation) {
  const std::string noise = "thermal:strength=0.01,time=0.25";
  const std::string cooling = "cooling:rate=2,out=0,in=0,activation=0.3";
  constexpr double kTime = 1.5;
  const Vec warm = contribution(space, noise, y, kTime),
            slower = contribution(space, cooling, y, kTime);
  for (const std::string& both : {noise + ";" + cooling, cooling + ";" + noise}) {
    const Vec cold = contribution(space, both, y, kTime) - slower;
    EXPECT_LT((cold - std::exp(-0.3 * kTime) * warm).norm(), 1e-10 * warm.norm()) << both;
  }
}

TEST_F(EffectPhysics, ThermalNoiseOfAnotherRunIsAnother) {
  const auto noise_of = [&](std::uint64_t run, const std::string& own) {
    problem::CahnHilliardModel model = make_model();
    model.seed = run;
    add_effects("thermal:strength=0.01,time=0.25" + own, kUnits, model);
    Vec r(2 * n);
    EXPECT_TRUE(problem::CahnHilliard(space, model).residual(0.1, y, Vec::Zero(2 * n), r).ok());
    return r;
  };
  EXPECT_EQ(noise_of(1, ""), noise_of(1, ",seed=1"));
  const Vec one = noise_of(1, ""), run = noise_of(2, ""), own = noise_of(1, ",seed=2");
  EXPECT_GT((one - run).norm(), 0.1 * one.norm());
  EXPECT_GT((one - own).norm(), 0.1 * one.norm());
  EXPECT_GT((run - own).norm(), 0.1 * one.norm());
}

// An energy that falls without end where c leaves [0, 1] would let small rafts run away.
TEST_F(EffectPhysics, AsymmetryLeavesTheWellsTheDeepestPlaces) {
  const Vec direction = random_vector(2 * n, 8);
  for (const char* effect : {"asymmetry:strength=0.2", "asymmetry:strength=-0.2"}) {
    problem::CahnHilliardModel model = make_model();
    add_effects(effect, kUnits, model);
    const problem::CahnHilliard problem(space, model);
    for (const double c : {-3.0, -0.5, -0.1, 0.1, 0.5, 0.9, 1.1, 1.5, 4.0})
      EXPECT_GT(problem.energy(Vec::Constant(2 * n, c)), 0) << effect << " at " << c;
    // Outside, too, the tangent is the derivative, and continuous at the wells.
    Vec wide = y;
    wide.head(n) = random_vector(n, 5, -0.5, 1.5);
    const auto residual_at = [&](double step) {
      Vec r(2 * n);
      EXPECT_TRUE(problem.residual(0, wide + step * direction, Vec::Zero(2 * n), r).ok());
      return r;
    };
    Vec product(2 * n);
    ASSERT_TRUE(problem
                    .jacobian_product(0, wide, Vec::Zero(2 * n), 0, linear::Tangent::exact,
                                      direction, product)
                    .ok());
    const Vec difference = (residual_at(1e-6) - residual_at(-1e-6)) / 2e-6;
    EXPECT_LT((product - difference).tail(n).norm(), 1e-6 * product.tail(n).norm()) << effect;
  }
}

}  // namespace
}  // namespace traceraft::effects
