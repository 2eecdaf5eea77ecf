// Brownian flow adds to a state as simulations with it say.
#include <gtest/gtest.h>

#include "backends/list.hpp"
#include "tests/support/spaces.hpp"
#include "verification/assimilation/filter/random_motion.hpp"

namespace traceraft::assimilation {
namespace {

using testing::make_model;
using testing::make_space;

class RandomMotionTest : public ::testing::Test {
 protected:
  static constexpr double kBegin = 1, kEnd = 1.6, kThermal = 2e-4;
  static constexpr int kSteps = 3;

  RandomMotionTest() : space(make_space(10)), base(space, make_model()) {
    data.space = space;
    data.mass = fem::as_eigen(*space, space->stabilised_mass);
    FilterProblems all{data};
    set_random_effects({find_candidate("brownian-flow").value(), find_candidate("flow").value()},
                       base.model(), all);
    data = all.front();
    c = advance(base, base.c_of(testing::noise_state(base, 3).y), 0, kBegin).end;
  }

  Forecast advance(const problem::CahnHilliard& problem, VecView from, double begin,
                   double end) const {
    const auto make_integrator = [this](const problem::DaeProblem& p) {
      time::IntegratorSettings settings;
      settings.tolerance = 1e-5;
      return backends::integrators()
          .find("rosenbrock")
          .make(p, backends::choose_linear_solver("direct", *space), space->team, settings);
    };
    return forecast(problem, make_integrator, from, begin, end, {kSteps});
  }
  Columns noises(double begin, double end) const {
    TangentFlow flow(base, backends::choose_linear_solver("direct", *space).primary,
                     std::make_shared<ThreadTeam>(2));
    return noises_at_end(data, *data.random.front().effect,
                         advance(base, c, begin, end).paths.front(), 120, flow);
  }
  double squares(const Columns& X) const { return X.cwiseProduct(data.mass * X).sum(); }

  std::shared_ptr<const fem::SurfaceSpace> space;
  problem::CahnHilliard base;
  FilterProblem data;
  Vec c;
};

TEST_F(RandomMotionTest, OneOfTheCandidatesIsRandom) {
  ASSERT_EQ(data.random.size(), 1U);
  EXPECT_EQ(data.random.front().name, "brownian-flow");
}

// The fields are the independent directions of a scatter, which 100 runs show with a known error.
// Velocities that are the same over a third of the time cost some percent.
TEST_F(RandomMotionTest, SimulationsScatterAsMuchAndInTheSameWay) {
  constexpr int kRuns = 100;
  const Columns fields = std::sqrt(kThermal) * noises(kBegin, kEnd);
  Columns runs(space->nodes(), kRuns);
  for (int seed = 0; seed < kRuns; ++seed) {
    problem::CahnHilliardModel model = base.model();
    model.seed = static_cast<std::uint64_t>(seed) + 1;
    Candidate candidate = find_candidate("brownian-flow").value();
    effects::EffectTerm term = candidate.term({kThermal});
    term.values[place_of("hold", effects::effects().find("flow").parameters)] = 0.03;
    runs.col(seed) =
        advance(problem::CahnHilliard(space, effects::with_effects(model, {term})), c, kBegin, kEnd)
            .end;
  }
  const Columns scatter = runs.colwise() - Vec(runs.rowwise().mean());
  const double expected = squares(fields), seen = squares(scatter) / (kRuns - 1);
  const Vec variances = (data.mass * fields).cwiseProduct(fields).colwise().sum().transpose();
  const double error = variances.norm() / variances.sum() * std::sqrt(2.0 / kRuns);
  EXPECT_LT(error, 0.1);
  EXPECT_NEAR(seen / expected, 1, 0.05 + 3 * error);
  // Along the direction in which the fields vary most.
  Eigen::Index largest = 0;
  variances.maxCoeff(&largest);
  const Vec most = data.mass * fields.col(largest);
  const double along = (fields.transpose() * most).squaredNorm(),
               seen_along = (scatter.transpose() * most).squaredNorm() / (kRuns - 1);
  EXPECT_NEAR(seen_along / along, 1, 0.42);
}

// In a short time nothing relaxes: variances add up.
TEST_F(RandomMotionTest, GrowsInProportionToAShortTime) {
  const double once = squares(noises(kBegin, kBegin + 1e-4)),
               twice = squares(noises(kBegin, kBegin + 2e-4));
  EXPECT_NEAR(twice / once, 2, 0.01);
  EXPECT_LT(squares(noises(kBegin, kEnd)), 0.9 * once * (kEnd - kBegin) / 1e-4);
}

TEST_F(RandomMotionTest, KeepsTheMass) {
  const Columns fields = noises(kBegin, kEnd);
  const Vec masses = fields.transpose() * (data.mass * Vec::Ones(space->nodes()));
  EXPECT_LT(masses.cwiseAbs().maxCoeff(), 1e-9 * std::sqrt(squares(fields)));
}

}  // namespace
}  // namespace traceraft::assimilation
