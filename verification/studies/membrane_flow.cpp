// Flow of the membrane on a sphere: energies of an independent program, the energy that friction
// takes, mass, and rafts that become round, wander and turn as theory says.
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>

#include "kernel/core/text.hpp"
#include "kernel/effects/brownian_flow.hpp"
#include "kernel/effects/capillary_flow.hpp"
#include "verification/analytic/cap_in_flow.hpp"
#include "verification/bench/bench.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/statistics/sample.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

using flow::FluidMembrane;

constexpr double kWater = 1.25;

bench::StartState start_of(const problem::CahnHilliard& problem,
                           const std::function<double(const Point&)>& c) {
  problem::InitialRequest request;
  request.formula = c;
  return bench::consistent_state(problem,
                                 problem::make_initial_field("formula", problem.space(), request));
}

problem::CahnHilliardModel model_of(double epsilon, problem::EffectPtr flow,
                                    const std::string& mobility = "degenerate") {
  problem::CahnHilliardModel model = bench::bench_model(mobility, epsilon);
  model.effects.push_back(std::move(flow));
  return model;
}

// Spherical harmonics up to a degree at which nothing changes, computed for this project.
struct Reference {
  double t, energy;
};
constexpr Reference kSpectral[] = {{1, 0.1773803}, {10, 0.1481835}, {40, 0.0948144}};
constexpr double kReferenceEpsilon = 0.1, kReferenceCapillary = 100;

double smooth_state(const Point& at) {
  const Point p = at.normalized();
  const double x = p[0], y = p[1], z = p[2];
  return 0.5 + 0.2 * x * y + 0.15 * (3 * z * z - 1) * x + 0.1 * std::sin(3 * z) +
         0.1 * x * (x * x - 3 * y * y);
}

problem::CahnHilliardModel reference_model(double capillary) {
  return model_of(kReferenceEpsilon, std::make_shared<effects::CapillaryFlow>(
                                         FluidMembrane{capillary, kWater, 0}, kReferenceEpsilon));
}

void measure_reference(const bench::Bench& bench, StudyReport& report) {
  bench::Table table{"energy", {"cells", "t", "energy", "spectral", "difference, %"}, {}};
  statistics::Points levels;
  double largest = 0;
  for (const int cells : bench.quick() ? std::vector<int>{24, 48} : std::vector<int>{32, 64}) {
    const bench::ProblemPtr problem =
        bench.problem(bench.space("sphere", cells), reference_model(kReferenceCapillary));
    const time::IntegratorPtr integrator = bench.default_integrator(*problem, 1e-4);
    std::size_t next = 0;
    Vec y(problem->size());
    largest = 0;
    bench::advance_to(*integrator, start_of(*problem, smooth_state), kSpectral[2].t, [&] {
      for (; next < std::size(kSpectral) && kSpectral[next].t <= integrator->time(); ++next) {
        const auto& [t, energy] = kSpectral[next];
        bench::require(integrator->interpolate(t, y));
        const double difference = problem->energy(y) / energy - 1;
        largest = statistics::larger(largest, std::fabs(difference));
        table.rows.push_back(
            {static_cast<double>(cells), t, problem->energy(y), energy, 100 * difference});
      }
    });
    levels.emplace_back(problem->space().h(), largest);
  }
  report.tables.push_back(table);
  report.claims.push_back(claim_at_most("energies: largest relative difference from the reference",
                                        largest, bench.quick() ? 1e-2 : 5e-3));
  report.claims.push_back(claim_order("energies: order in h", levels, 2, 0.5));
}

// Mobility and friction take as much of the energy per time. With ẏ = 0 the first half of the
// residual of the model without flow is what mobility moves.
struct Dissipation {
  double mobility, friction;
};
Dissipation dissipation_of(const problem::CahnHilliard& problem, const problem::CahnHilliard& base,
                           const effects::CapillaryFlow& flow, const Vec& y) {
  Vec r(y.size());
  bench::require(base.residual(0, y, Vec::Zero(r.size()), r));
  return {problem.mu_of(y).dot(r.head(problem.block_size())),
          flow.dissipation(problem.space(), problem.c_of(y), problem.mu_of(y))};
}

void measure_dissipation(const bench::Bench& bench, const std::string& surface,
                         StudyReport& report) {
  const bench::SpacePtr space = bench.space(surface, 48);
  const bench::ProblemPtr problem = bench.problem(space, reference_model(kReferenceCapillary)),
                          base = bench.problem(space,
                                               bench::bench_model("degenerate", kReferenceEpsilon));
  const bench::StartState here = start_of(*problem, smooth_state);
  const double step = 1e-5;
  const double slope =
      (problem->energy(here.y + step * here.ydot) - problem->energy(here.y - step * here.ydot)) /
      (2 * step);
  const Dissipation taken = dissipation_of(
      *problem, *base, effects::CapillaryFlow({kReferenceCapillary, kWater, 0}, kReferenceEpsilon),
      here.y);
  report.claims.push_back(
      claim_at_most(surface + ": dE/dt + dissipation by mobility + by friction, relative",
                    std::fabs(slope + taken.mobility + taken.friction) / -slope, 1e-6));
  report.notes.push_back(formatted("Friction takes %.2g of what this state loses on the %s.",
                                   taken.friction / -slope, surface.c_str()));
}

// Parts of the energy of the smooth state that mobility and friction have taken until t = 12, at A
// = 1000, by the same independent program.
void measure_shares(const bench::Bench& bench, StudyReport& report) {
  constexpr double kCapillary = 1000, kEnd = 12, kFall = 0.09240666;
  constexpr Dissipation kTaken{0.05630, 0.03610};
  const bench::SpacePtr space = bench.space("sphere", bench.quick() ? 32 : 64);
  const bench::ProblemPtr problem = bench.problem(space, reference_model(kCapillary)),
                          base = bench.problem(space,
                                               bench::bench_model("degenerate", kReferenceEpsilon));
  const effects::CapillaryFlow flow({kCapillary, kWater, 0}, kReferenceEpsilon);
  const time::IntegratorPtr integrator = bench.default_integrator(*problem, 1e-4);
  const bench::StartState start = start_of(*problem, smooth_state);
  Dissipation before = dissipation_of(*problem, *base, flow, start.y), taken{0, 0};
  double t = 0;
  bench::advance_to(*integrator, start, kEnd, [&] {
    const Dissipation now = dissipation_of(*problem, *base, flow, integrator->state());
    const double half = 0.5 * (std::min(integrator->time(), kEnd) - t);
    taken.mobility += half * (before.mobility + now.mobility);
    taken.friction += half * (before.friction + now.friction);
    t = integrator->time();
    before = now;
  });
  Vec end(problem->size());
  bench::require(integrator->interpolate(kEnd, end));
  const double margin = bench.quick() ? 0.02 : 0.005;
  const auto claim = [&](const char* what, double measured, double exact) {
    report.claims.push_back(claim_near(formatted("A = 1000, t = 12: %s / spectral", what),
                                       measured / exact, 1, margin));
  };
  claim("fall of the energy", problem->energy(start.y) - problem->energy(end), kFall);
  claim("energy that mobility takes", taken.mobility, kTaken.mobility);
  claim("energy that friction takes", taken.friction, kTaken.friction);
}

// ∫ c Re (x + iy)^m: proportional to the amplitude of a boundary at angle + δ cos mφ.
double amplitude(const problem::CahnHilliard& problem, const Vec& y, int m) {
  const fem::SurfaceSpace& space = problem.space();
  Vec weight(space.nodes());
  for (int i = 0; i < space.nodes(); ++i) {
    const Point x = space.mesh.position(i);
    weight[i] = std::real(std::pow(std::complex<double>(x[0], x[1]), m));
  }
  return space.inner(weight, problem.c_of(y));
}

double measured_relaxation(const bench::Bench& bench, const FluidMembrane& membrane, double epsilon,
                           double angle, int m, int cells) {
  const bench::ProblemPtr problem =
      bench.problem(bench.space("sphere", cells),
                    model_of(epsilon, std::make_shared<effects::CapillaryFlow>(membrane, epsilon)));
  const bench::StartState start = start_of(*problem, [&](const Point& x) {
    const double theta = std::atan2(std::hypot(x[0], x[1]), x[2]), phi = std::atan2(x[1], x[0]);
    return problem->model().well.profile(theta - angle - 0.05 * std::cos(m * phi), epsilon);
  });
  const double scale = 1 / analytic::relaxation_rate(membrane, epsilon, angle, m);
  const time::IntegratorPtr integrator = bench.default_integrator(*problem, 1e-4);
  statistics::Points decay;
  bench::advance_to(*integrator, start, 0.6 * scale, [&] {
    if (integrator->time() > 0.1 * scale)
      decay.emplace_back(integrator->time(),
                         std::log(std::fabs(amplitude(*problem, integrator->state(), m))));
  });
  return -statistics::fit_line(decay).slope;
}

void measure_relaxation(const bench::Bench& bench, StudyReport& report) {
  constexpr double kAngle = 0.8;
  const FluidMembrane membrane{1e5, kWater, 0};
  bench::Table table{"relaxation", {"mode", "epsilon", "cells", "rate", "theory", "ratio"}, {}};
  const std::vector<double> widths =
      bench.quick() ? std::vector<double>{0.1, 0.05} : std::vector<double>{0.1, 0.05, 0.025};
  for (const int m : {2, 3}) {
    statistics::Points levels;
    for (const double epsilon : widths) {
      const int cells = static_cast<int>(std::lround(4 / epsilon));
      const double theory = analytic::relaxation_rate(membrane, epsilon, kAngle, m);
      const double rate = measured_relaxation(bench, membrane, epsilon, kAngle, m, cells);
      levels.emplace_back(epsilon, std::fabs(rate / theory - 1));
      table.rows.push_back({static_cast<double>(m), epsilon, static_cast<double>(cells), rate,
                            theory, rate / theory});
    }
    const std::string what = formatted("mode %d of a cap, rate of becoming round: ", m);
    report.claims.push_back(claim_at_most(what + "relative difference from a sharp boundary",
                                          levels.back().second, bench.quick() ? 0.15 : 0.06));
    report.claims.push_back(claim_at_least(what + "order in epsilon of this difference",
                                           statistics::observed_order(levels).order, 1));
  }
  report.tables.push_back(table);
}

// Two rafts that overlap by a tenth of their radius become one, and this becomes round. With s(c) =
// c²(3 − 2c) the elongation is |∫ s (x + iy)²|/∫ s (x² + y²). It falls at the rate of mode 2 in the
// end, if boundaries restore their profile in less time than flow stretches them in. So flow is
// slow here, and the mobility constant: with A = 1e5 the rate was half as large.
struct Merging {
  double rate;    // over that of mode 2 of the round raft of the same area
  double halved;  // time in which the elongation falls to a half, times that rate
};
bench::StartState two_rafts(const problem::CahnHilliard& problem) {
  constexpr double kRadius = 0.4, kApart = 0.9 * kRadius;  // half of the distance
  return start_of(problem, [&](const Point& x) {
    double nearest = kPi;
    for (const double side : {-1.0, 1.0}) {
      const Point centre(side * std::sin(kApart), 0, std::cos(kApart));
      nearest = std::min(nearest, std::acos(std::clamp(centre.dot(x.normalized()), -1.0, 1.0)));
    }
    return problem.model().well.profile(nearest - kRadius, problem.model().epsilon);
  });
}
Merging measured_merging(const bench::Bench& bench, const FluidMembrane& membrane, double epsilon,
                         int cells) {
  const bench::ProblemPtr problem =
      bench.problem(bench.space("sphere", cells),
                    model_of(epsilon, std::make_shared<effects::CapillaryFlow>(membrane, epsilon),
                             "constant:value=0.25"));
  const bench::StartState start = two_rafts(*problem);
  const fem::SurfaceSpace& space = problem->space();
  Vec square(space.nodes()), difference(space.nodes());
  for (int i = 0; i < space.nodes(); ++i) {
    const Point x = space.mesh.position(i);
    square[i] = x[0] * x[0] + x[1] * x[1];
    difference[i] = x[0] * x[0] - x[1] * x[1];
  }
  const auto elongation = [&](const Vec& y) {
    const Vec inside = problem->c_of(y).unaryExpr([](double c) { return c * c * (3 - 2 * c); });
    return std::fabs(space.inner(difference, inside)) / space.inner(square, inside);
  };
  const double angle = std::acos(1 - problem->mass(start.y) / (2 * kPi)),
               theory = analytic::relaxation_rate(membrane, epsilon, angle, 2),
               first = elongation(start.y);
  const time::IntegratorPtr integrator = bench.default_integrator(*problem, 1e-4);
  statistics::Points late;
  double halved = 0;
  bench::advance_to(*integrator, start, 5 / theory, [&] {
    const double now = elongation(integrator->state());
    if (halved == 0 && now < 0.5 * first) halved = integrator->time();
    if (now < 0.2 * first && now > 0.02 * first)
      late.emplace_back(integrator->time(), std::log(now));
  });
  return {-statistics::fit_line(late).slope / theory, halved * theory};
}

void measure_merging(const bench::Bench& bench, StudyReport& report) {
  const FluidMembrane membrane{1e3, kWater, 0};
  bench::Table table{
      "merging", {"epsilon", "cells", "late rate / mode 2", "time to half / mode 2"}, {}};
  Merging last{};
  for (const double epsilon :
       bench.quick() ? std::vector<double>{0.05} : std::vector<double>{0.05, 0.025}) {
    const int cells = static_cast<int>(std::lround(4 / epsilon));
    last = measured_merging(bench, membrane, epsilon, cells);
    table.rows.push_back({epsilon, static_cast<double>(cells), last.rate, last.halved});
  }
  report.tables.push_back(table);
  report.claims.push_back(claim_near("two rafts that merge: late rate of becoming round / theory",
                                     last.rate, 1, bench.quick() ? 0.15 : 0.1));
}

// Angular velocities are of the modes with l = 1, and D_r = Θ/(8π W) in R²/D whatever the membrane.
void measure_rotation(const bench::Bench& bench, StudyReport& report) {
  constexpr int kDraws = 10000;
  constexpr double kHold = 0.1;
  const FluidMembrane membrane{0, kWater, 1e-3};
  const bench::SpacePtr space = bench.space("sphere", 12);
  const effects::BrownianFlow flow(membrane, 0.1, kHold, 1);
  double squares = 0;
  for (int k = 0; k < kDraws; ++k)
    squares += flow.draw(*space, k).segment<3>(flow::harmonic_index(1, -1)).squaredNorm();
  // Y_1m = √(3/4π) x_m.
  const double rate = squares / kDraws / 3 * 3 / (4 * kPi) * kHold / 2;
  const double theory = membrane.thermal / (8 * kPi * kWater);
  report.claims.push_back(claim_near("rotation of the vesicle: diffusion / k_B T/(8 pi eta_w R^3)",
                                     rate / theory, 1, 3 * std::sqrt(2.0 / (3 * kDraws)),
                                     2 * std::sqrt(2.0 / (3 * kDraws))));
}

// The diffusion of a walk whose displacements d_k in a plane, each in a time τ, know the ones
// beside them: velocities are linear between draws.
struct Diffusion {
  double value, deviation;
};
Diffusion diffusion_of(const std::vector<Point>& centres, double hold) {
  constexpr std::size_t kBatches = 20;
  std::vector<double> batches(kBatches, 0.0);
  const std::size_t pairs = centres.size() - 2, each = pairs / kBatches;
  for (std::size_t k = 0; k < each * kBatches; ++k) {
    const Point now = centres[k + 1] - centres[k], next = centres[k + 2] - centres[k + 1];
    batches[k / each] += (now.squaredNorm() + 2 * now.dot(next)) / (4 * hold) / each;
  }
  const statistics::Sample sample = statistics::sample_of(batches);
  return {sample.mean, sample.deviation / std::sqrt(static_cast<double>(kBatches))};
}

// A cap in Brownian flow, which line tension keeps round.
void measure_wandering(const bench::Bench& bench, StudyReport& report) {
  constexpr double kEpsilon = 0.1, kAngle = 1, kHold = 0.01;
  const FluidMembrane membrane{1e4, kWater, 0.02};
  const int holds = bench.quick() ? 400 : 4000, cells = bench.quick() ? 24 : 32;
  problem::CahnHilliardModel model =
      model_of(kEpsilon, std::make_shared<effects::CapillaryFlow>(membrane, kEpsilon));
  model.effects.push_back(std::make_shared<effects::BrownianFlow>(membrane, kEpsilon, kHold, 1));
  const bench::ProblemPtr problem = bench.problem(bench.space("sphere", cells), model);
  const fem::SurfaceSpace& space = problem->space();
  Eigen::MatrixX3d position(space.nodes(), 3);
  for (int i = 0; i < space.nodes(); ++i) position.row(i) = space.mesh.position(i);
  const auto centre_of = [&](const Vec& y) {
    Point centre;
    for (int d = 0; d < 3; ++d) centre[d] = space.inner(position.col(d), problem->c_of(y));
    return centre.normalized();
  };
  problem::InitialRequest request;
  request.caps = {{Point(0, 0, 1), kAngle}};
  const bench::StartState start = bench::initial_state(*problem, "caps", request);
  const time::IntegratorPtr integrator = bench.default_integrator(*problem, 1e-3);
  const double mass = problem->mass(start.y);
  std::vector<Point> centres{centre_of(start.y)};
  Vec y(problem->size());
  double drift = 0, steps = 0;
  bench::advance_to(*integrator, start, holds * kHold, [&] {
    ++steps;
    drift = statistics::larger(drift, std::fabs(problem->mass(integrator->state()) / mass - 1));
    while (static_cast<double>(centres.size()) * kHold <= integrator->time() * (1 + 1e-12) &&
           centres.size() <= static_cast<std::size_t>(holds)) {
      bench::require(integrator->interpolate(static_cast<double>(centres.size()) * kHold, y));
      centres.push_back(centre_of(y));
    }
  });
  const Diffusion measured = diffusion_of(centres, kHold);
  const double theory =
      analytic::centre_diffusion(membrane, kEpsilon, kAngle, flow::brownian_degree(kEpsilon));
  report.claims.push_back(claim_near("centre of a raft: diffusion / theory",
                                     measured.value / theory, 1, 3 * measured.deviation / theory,
                                     2 * measured.deviation / theory));
  report.claims.push_back(
      claim_at_most("Brownian flow: largest relative drift of the mass", drift, 1e-12));
  report.notes.push_back(
      formatted("The raft that wanders is a cap of %g rad with epsilon = %g R, "
                "followed over %d holds in %.0f steps.",
                kAngle, kEpsilon, holds, steps));
}

StudyReport run(const bench::Bench& bench) {
  StudyReport report;
  report.notes = {
      formatted("The sphere has W = %g. The energies are of a smooth state with "
                "epsilon = 0.1 R and A = 100.",
                kWater)};
  measure_reference(bench, report);
  bench.progress(0.5);
  for (const char* surface : {"sphere", "ellipsoid", "biconcave"})
    measure_dissipation(bench, surface, report);
  measure_shares(bench, report);
  measure_relaxation(bench, report);
  measure_merging(bench, report);
  measure_rotation(bench, report);
  measure_wandering(bench, report);
  return report;
}

}  // namespace

StudyEntry membrane_flow_study() {
  return {"flow",
          "flow of the membrane: energy, friction, mass, rafts that become round and wander", run};
}

}  // namespace traceraft::studies
