// Every verification study can fail: parts of the program are broken on purpose, and the claims
// that are about them do not hold.
#include <gtest/gtest.h>

#include <functional>
#include <mutex>

#include "tests/support/forwarding.hpp"
#include "verification/bench/bench.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft {
namespace {

using testing::ForwardingProblem;

// The problem that an integrator is given in place of the model.
class BrokenProblem : public ForwardingProblem {
 public:
  using ForwardingProblem::ForwardingProblem;
  double clock = 1;     // factor of ẏ: time runs slower
  double leak = 0;      // source of mass, per area
  double shift = 1;     // factor of the shift in the Jacobian
  bool uphill = false;  // the flux has the wrong sign

  Status residual(double t, VecView y, VecView ydot, VecRef r) const override {
    const Status status = ForwardingProblem::residual(t, y, clock * ydot, r);
    r.head(block_size()).array() -= leak;
    if (uphill) {
      Vec flux(r.size());  // at ẏ = 0 nothing else is left in the first half
      if (!ForwardingProblem::residual(t, y, Vec::Zero(r.size()), flux).ok()) return status;
      r.head(block_size()) -= 2 * flux.head(block_size());
    }
    return status;
  }
  Status jacobian(double t, VecView y, VecView ydot, double sigma, linear::Tangent tangent,
                  linear::BlockJacobian& J) const override {
    return ForwardingProblem::jacobian(t, y, clock * ydot, clock * shift * sigma, tangent, J);
  }
  Status jacobian_product(double t, VecView y, VecView ydot, double sigma, linear::Tangent tangent,
                          VecView v, VecRef product) const override {
    return ForwardingProblem::jacobian_product(t, y, clock * ydot, clock * shift * sigma, tangent,
                                               v, product);
  }
};

// A law that is off by a factor.
class ScaledMobility final : public physics::Mobility {
 public:
  ScaledMobility(physics::MobilityPtr inner, double factor)
      : inner_(std::move(inner)), factor_(factor) {}
  void evaluate(const double* c, int count, double* value, double* derivative) const override {
    inner_->evaluate(c, count, value, derivative);
    for (int i = 0; i < count; ++i) {
      value[i] *= factor_;
      if (derivative) derivative[i] *= factor_;
    }
  }
  double scale() const override { return factor_ * inner_->scale(); }
  bool constant() const override { return inner_->constant(); }

 private:
  physics::MobilityPtr inner_;
  double factor_;
};

// An effect that is stronger by a factor than it says.
class ScaledEffect final : public problem::Effect {
 public:
  ScaledEffect(problem::EffectPtr inner, double factor)
      : inner_(std::move(inner)), factor_(factor) {}
  std::string name() const override { return inner_->name(); }
  bool conserves_mass() const override { return inner_->conserves_mass(); }
  bool dissipates_energy() const override { return inner_->dissipates_energy(); }
  bool tangent_is_assembled() const override { return false; }
  double longest_step() const override { return inner_->longest_step(); }

  void add_residual(const fem::SurfaceSpace& space, double t, VecView c, VecView mu, VecRef r_c,
                    VecRef r_mu) const override {
    Vec own_c = Vec::Zero(r_c.size()), own_mu = own_c;
    inner_->add_residual(space, t, c, mu, own_c, own_mu);
    r_c += factor_ * own_c;
    r_mu += factor_ * own_mu;
  }
  void add_tangent(const fem::SurfaceSpace&, double, VecView, VecView,
                   linear::BlockJacobian&) const override {}
  void add_tangent_product(const fem::SurfaceSpace& space, double t, VecView c, VecView mu,
                           VecView by_c, VecView by_mu, VecRef p_c, VecRef p_mu) const override {
    Vec own_c = Vec::Zero(p_c.size()), own_mu = own_c;
    inner_->add_tangent_product(space, t, c, mu, by_c, by_mu, own_c, own_mu);
    p_c += factor_ * own_c;
    p_mu += factor_ * own_mu;
  }

 private:
  problem::EffectPtr inner_;
  double factor_;
};

// Runs of the program that are not what they should be.
bench::RunProgram broken_program(double drift, double shift) {
  return [=](const std::vector<std::string>&, int ranks, int nodes) {
    return bench::ProgramRun{10, drift, Vec::Constant(nodes, ranks == 1 ? 0.5 : 0.5 + shift)};
  };
}

struct Fault {
  const char* study;
  const char* what;
  std::vector<std::string> claims;  // words of those that see it; none: the computation fails
  std::function<void(problem::CahnHilliardModel&)> model = {};
  std::function<void(BrokenProblem&)> problem = {};
  const char* integrator = "";  // that gets the broken problem; "" for all
  double inflation = 0;         // of the surface
  bool no_stabilisation = false;
  bench::RunProgram program = {};
  const char* seen_on_ranks = "";  // the claim that sees `program`, if solvers work on ranks
  const char* failure = "";        // words of why the computation fails
  std::function<void(discs::DiscModel&)> discs = {};
  std::function<void(fem::RefinementRule&)> rule = {};
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) {
  return out << fault.study << ": " << fault.what;
}

class BrokenBench final : public bench::Bench {
 public:
  explicit BrokenBench(const Fault& fault)
      : bench::Bench({true, "", "", 1, {}, fault.program}), fault_(fault) {}

  using bench::Bench::space;
  bench::SpacePtr space(geometry::LevelSetPtr surface, int cells, int threads) const override {
    const auto result = std::make_shared<fem::SurfaceSpace>(
        std::make_shared<geometry::FunctionLevelSet>(
            [surface, inflation = fault_.inflation](const Point& x) {
              return surface->value(x) - inflation;
            }),
        cells, std::make_shared<ThreadTeam>(threads), std::make_shared<SerialCommunicator>());
    if (fault_.no_stabilisation) {
      std::fill(result->normal_stiffness.values.begin(), result->normal_stiffness.values.end(),
                0.0);
      result->stabilised_mass = result->mass;
    }
    return result;
  }
  bench::ProblemPtr problem(bench::SpacePtr space,
                            problem::CahnHilliardModel model) const override {
    if (fault_.model) fault_.model(model);
    if (fault_.no_stabilisation) model.stabilisation = 0;
    return bench::Bench::problem(std::move(space), std::move(model));
  }
  discs::DiscModel disc_model(discs::DiscModel model) const override {
    if (fault_.discs) fault_.discs(model);
    return model;
  }
  fem::RefinementRule refinement_rule(fem::RefinementRule rule) const override {
    if (fault_.rule) fault_.rule(rule);
    return rule;
  }
  time::IntegratorPtr make_integrator(const problem::DaeProblem& problem,
                                      const fem::SurfaceSpace& space, const std::string& name,
                                      const std::string& linear_solver,
                                      const time::IntegratorSettings& settings) const override {
    auto broken = std::make_unique<BrokenProblem>(problem);
    if (fault_.problem && (*fault_.integrator == 0 || fault_.integrator == name))
      fault_.problem(*broken);
    const BrokenProblem& problem_of_integrator = *broken;
    {
      const std::lock_guard lock(mutex_);
      broken_.push_back(std::move(broken));
    }
    return bench::Bench::make_integrator(problem_of_integrator, space, name, linear_solver,
                                         settings);
  }

 private:
  const Fault& fault_;
  // Integrators refer to their problem; members of an ensemble are made at the same time.
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<BrokenProblem>> broken_;
};

// Not of those whose names have the words, of which there is one.
bool any_holds(const studies::StudyReport& report, const std::string& words) {
  bool found = false;
  for (const studies::Claim& claim : report.claims) {
    if (claim.what.find(words) == std::string::npos) continue;
    if (claim.holds()) return true;
    found = true;
  }
  EXPECT_TRUE(found) << "no claim about " << words;
  return false;
}

class FaultTest : public ::testing::TestWithParam<Fault> {};

TEST_P(FaultTest, IsSeen) {
  const Fault& fault = GetParam();
  const BrokenBench bench(fault);
  const auto run = [&] { return studies::studies().find(fault.study).run(bench); };
  if (fault.claims.empty()) {
    try {
      (void)run();
      ADD_FAILURE() << "nothing has failed";
    } catch (const std::runtime_error& error) {
      ASSERT_STRNE(fault.failure, "");
      EXPECT_NE(std::string(error.what()).find(fault.failure), std::string::npos) << error.what();
    }
    return;
  }
  const studies::StudyReport report = run();
  if (!report.skipped.empty()) GTEST_SKIP() << report.skipped;
  for (const std::string& claim : fault.claims) EXPECT_FALSE(any_holds(report, claim)) << claim;
  if (fault.program && !bench.linear_solvers_on_ranks().empty()) {
    EXPECT_FALSE(any_holds(report, fault.seen_on_ranks)) << fault.seen_on_ranks;
  }
}

const Fault kFaults[] = {
    {"mass",
     "a leak of 1e-9 per area, and ranks that lose mass",
     {"drift of the mass"},
     {},
     [](BrokenProblem& p) { p.leak = 1e-9; },
     "",
     0,
     false,
     broken_program(1e-11, 0),
     "on two ranks"},
    {"energy",
     "time that runs 2 % slow",
     {"order of the dissipation identity"},
     {},
     [](BrokenProblem& p) { p.clock = 1.02; }},
    {"energy",
     "a flux uphill",
     {},
     {},
     [](BrokenProblem& p) { p.uphill = true; },
     "",
     0,
     false,
     {},
     "",
     "no step size"},
    {"convergence",
     "a boundary 2 % too wide",
     {"full system, c in L2", "full system, mu in L2"},
     [](problem::CahnHilliardModel& m) { m.epsilon *= 1.02; }},
    {"geometry",
     "a surface 1e-3 too large, and no stabilisation",
     {"sphere: order of the area", "torus: order of the area",
      "largest condition number of M + 0.3 h S"},
     {},
     {},
     "",
     1e-3,
     true},
    {"time-order",
     "a wrong shift",
     {"stabilised Euler: order in the step", "stabilised BDF2: order in the step"},
     {},
     [](BrokenProblem& p) { p.shift = 1.1; },
     "euler"},
    {"linear",
     "a mobility 5 % too small",
     {"order of the rates in h"},
     [](problem::CahnHilliardModel& m) {
       m.mobility = std::make_shared<ScaledMobility>(m.mobility, 0.95);
     }},
    {"equilibria",
     "a well 2 % too deep",
     {"energy of a boundary", "energy per length", "width of a boundary"},
     [](problem::CahnHilliardModel& m) { m.well.rho *= 1.02; }},
    {"coarsening",
     "a mobility that vanishes in the phases",
     {"exponent in t + offset"},
     [](problem::CahnHilliardModel& m) { m.mobility = physics::make_mobility("degenerate"); }},
    {"flow",
     "flow 20 % faster than its force and its draws say, and a leak of 1e-9 per area",
     {"sphere: dE/dt + dissipation", "ellipsoid: dE/dt + dissipation",
      "biconcave: dE/dt + dissipation", "A = 1000, t = 12: energy that friction takes",
      "centre of a raft", "largest relative drift of the mass"},
     [](problem::CahnHilliardModel& m) {
       for (problem::EffectPtr& effect : m.effects)
         effect = std::make_shared<ScaledEffect>(effect, 1.2);
     },
     [](BrokenProblem& p) { p.leak = 1e-9; }},
    {"flow",
     "flow 10 % slower than its force says, and a mobility 5 % too small",
     {"energies: largest", "mode 2 of a cap, rate of becoming round: relative",
      "mode 3 of a cap, rate of becoming round: relative", "two rafts that merge"},
     [](problem::CahnHilliardModel& m) {
       m.mobility = std::make_shared<ScaledMobility>(m.mobility, 0.95);
       for (problem::EffectPtr& effect : m.effects)
         effect = std::make_shared<ScaledEffect>(effect, 0.9);
     }},
    {"flow-coarsening",
     "no flow in fields, and the drag of another fluid in discs",
     {"perimeter at the end", "drag of the water: exponent", "drag of the membrane: exponent"},
     [](problem::CahnHilliardModel& m) { m.effects.clear(); },
     {},
     "",
     0,
     false,
     {},
     "",
     "",
     [](discs::DiscModel& m) { m.membrane.water = m.membrane.water > 1 ? 0.05 : 100; }},
    {"discs",
     "a field with boundaries 15 % too wide",
     {"energy, discs / field"},
     [](problem::CahnHilliardModel& m) { m.epsilon *= 1.15; }},
    {"published",
     "a membrane ten times as viscous",
     {"2:1: root mean square", "3:1: root mean square"},
     {},
     {},
     "",
     0,
     false,
     {},
     "",
     "",
     [](discs::DiscModel& m) { m.membrane.thermal *= 0.1; }},
    {"pfhub",
     "a well 5 % too deep",
     {"t = 0.1 to 100: largest relative difference"},
     [](problem::CahnHilliardModel& m) { m.well.rho *= 1.05; }},
    {"agreement",
     "an integrator 0.1 % slow, and ranks that get another result",
     {"largest distance at tolerance"},
     {},
     [](BrokenProblem& p) { p.clock = 1.001; },
     "euler",
     0,
     false,
     broken_program(0, 1e-3),
     "between 1 and 2 ranks"},
    {"iterations", "no stabilisation", {}, {}, {}, "", 0, true, {}, "", "no step size"},
    {"teko",
     "no stabilisation",
     {"muelu (default): most iterations to 1e-8", "muelu (default): systems that are not solved"},
     {},
     {},
     "",
     0,
     true},
    {"adaptive",
     "boundaries on cells that are too large",
     {"time of vanishing, adaptive / uniform"},
     {},
     {},
     "",
     0,
     false,
     {},
     "",
     "",
     {},
     [](fem::RefinementRule& r) { r.threshold *= 60; }},
};

INSTANTIATE_TEST_SUITE_P(Broken, FaultTest, ::testing::ValuesIn(kFaults), [](const auto& info) {
  std::string name = std::string(info.param.study) + "_" + info.param.what;
  for (char& ch : name)
    if (!std::isalnum(static_cast<unsigned char>(ch))) ch = '_';
  return name;
});

TEST(Faults, EveryStudyOfAllHasOne) {
  for (const studies::StudyEntry& study : studies::studies()) {
    if (study.by_name_only) continue;
    bool found = false;
    for (const Fault& fault : kFaults) found = found || study.name == fault.study;
    EXPECT_TRUE(found) << study.name;
  }
}

}  // namespace
}  // namespace traceraft
