// Equilibria: profile, energy and width of a phase boundary against the one-dimensional solution on
// the sphere; the angle of a cap and the shift of c inside it against the sharp-interface limit;
// the end of the smaller of two rafts.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/core/random.hpp"
#include "kernel/core/text.hpp"
#include "kernel/observables/rafts.hpp"
#include "verification/analytic/sphere_boundary.hpp"
#include "verification/bench/bench.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/statistics/random_streams.hpp"
#include "verification/statistics/sample.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

constexpr const char* kMobility = "constant:value=0.25";

struct Equilibrium {
  bench::SpacePtr space;
  bench::ProblemPtr problem;
  Vec y;
  observables::RaftReport rafts;
};

// An axis that lies anyhow in the mesh.
const Point kAxis = Point(1, 2, 3).normalized();

// A cap of the given half angle, left to itself.
Equilibrium relaxed_cap(const bench::Bench& bench, const bench::SpacePtr& space, double epsilon,
                        double angle, double t_end, const Point& axis = kAxis) {
  Equilibrium result;
  result.space = space;
  result.problem = bench.problem(result.space, bench::bench_model(kMobility, epsilon));
  problem::InitialRequest request;
  request.caps = {{axis, angle}};
  const time::IntegratorPtr integrator = bench.default_integrator(*result.problem);
  bench::advance_to(*integrator, bench::initial_state(*result.problem, "caps", request), t_end);
  result.y = integrator->state();
  result.rafts = observables::RaftFinder(result.space).find(result.problem->c_of(result.y), 0.5);
  return result;
}

// ∫ c (1 − c); √2 ε per length of a flat boundary.
double width(const Equilibrium& state) {
  const auto c = state.problem->c_of(state.y);
  return state.space->integral(c) - state.space->inner(c, c);
}

// Largest distance, over the points of Γ_h, of c from the profile around the great circle at
// `axis`.
double profile_error(const Equilibrium& state, const analytic::SphereBoundary& boundary,
                     const Point& axis) {
  const mesh::CutSurface& surface = state.space->surface;
  const auto c = state.problem->c_of(state.y);
  double worst = 0;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const double angle =
        std::asin(std::clamp(axis.dot(surface.position[i].normalized()), -1.0, 1.0));
    worst =
        statistics::larger(worst, std::fabs(surface.points[i].trace(c) - boundary.profile(angle)));
  }
  return worst;
}

void measure_boundary(const bench::Bench& bench, StudyReport& report) {
  bench::Table table{"boundary",
                     {"cells", "epsilon", "h/epsilon", "energy", "width", "level curve", "profile"},
                     {}};
  const int finest = bench.quick() ? 128 : 256;
  const double epsilon = 0.05;
  const analytic::SphereBoundary boundary(physics::DoubleWell{}, epsilon);
  const double length = 2 * kPi;
  const double flat =
      boundary.energy() / length / (epsilon * physics::DoubleWell{}.interface_energy());
  statistics::Points energy, profile;
  double last_width = 0, level_curve = 0;
  for (int cells = finest / 4; cells <= finest; cells *= 2) {
    const Equilibrium state =
        relaxed_cap(bench, bench.space("sphere", cells), epsilon, kPi / 2, 100);
    const double h = state.space->h();
    energy.emplace_back(h, state.problem->energy(state.y) / boundary.energy() - 1);
    profile.emplace_back(h, profile_error(state, boundary, kAxis));
    last_width = width(state) / boundary.width();
    level_curve = state.rafts.perimeter / length;
    table.rows.push_back({static_cast<double>(cells), epsilon, h / epsilon,
                          1 + energy.back().second, last_width, level_curve,
                          profile.back().second});
  }
  report.tables.push_back(table);
  report.charts.push_back({"A phase boundary on finer meshes",
                           "h",
                           "relative error",
                           true,
                           true,
                           {{"energy", energy}, {"profile", profile}}});
  report.claims.push_back(
      claim_near("energy of a boundary / energy of the equilibrium on the sphere",
                 1 + energy.back().second, 1, 0.005));
  report.claims.push_back(claim_near("energy per length of a boundary / (epsilon/(6 sqrt 2))",
                                     flat * (1 + energy.back().second), 1, 0.005));
  report.claims.push_back(claim_near("width of a boundary / width of the equilibrium on the sphere",
                                     last_width, 1, 0.005));
  report.claims.push_back(
      claim_near("two equal halves: length of the level curve / 2 pi R", level_curve, 1, 0.001));
  report.claims.push_back(claim_order(
      "largest distance of c from the equilibrium on the sphere: order in h", profile, 2, 0.4));
}

// On a mesh as coarse as the paper's the energy depends on how a boundary lies in the mesh.
void measure_directions(const bench::Bench& bench, StudyReport& report) {
  constexpr int kCells = 48;
  constexpr double kRatio = 2.6;  // h/ε
  const bench::SpacePtr space = bench.space("sphere", kCells);
  const double epsilon = space->h() / kRatio;
  const double exact = analytic::SphereBoundary(physics::DoubleWell{}, epsilon).energy();
  bench::Table table{"directions", {"axis", "energy"}, {}};
  std::vector<double> energies;
  for (std::uint64_t k = 0; k < 30; ++k) {
    const Point axis =
        uniform_direction(uniform_random(statistics::fixed_seed::test_vectors, 1, k),
                          uniform_random(statistics::fixed_seed::test_vectors, 2, k));
    const Equilibrium state = relaxed_cap(bench, space, epsilon, kPi / 2, 100, axis);
    energies.push_back(state.problem->energy(state.y) / exact);
    table.rows.push_back(
        {formatted("(%.2f, %.2f, %.2f)", axis[0], axis[1], axis[2]), energies.back()});
  }
  report.tables.push_back(table);
  const statistics::Sample found = statistics::sample_of(energies);
  report.claims.push_back(claim_near(
      "energy of a boundary / energy of the equilibrium at h/epsilon = 2.6, mean over directions",
      found.mean, 1, 0.005));
  report.claims.push_back(
      claim_at_most("standard deviation of this ratio over directions", found.deviation, 0.006));
}

// Gibbs–Thomson on the sphere, to first order in ε: μ = σ κ_g with σ = ε/(6√2) and the geodesic
// curvature κ_g = cot θ raises c by δ = 2μ = ε cot θ/(3√2) in both phases; the mass then fixes θ:
// m = 2π(1 − cos θ) + 4π δ.
double gibbs_thomson(double epsilon, double angle) {
  return epsilon / (3 * std::sqrt(2.0) * std::tan(angle));
}

double cap_angle(double mass, double epsilon) {
  double low = 0.05, high = kPi - 0.05;
  for (int i = 0; i < 60; ++i) {
    const double angle = 0.5 * (low + high);
    const double has = 2 * kPi * (1 - std::cos(angle)) + 4 * kPi * gibbs_thomson(epsilon, angle);
    (has < mass ? low : high) = angle;
  }
  return 0.5 * (low + high);
}

struct CapErrors {
  double angle, perimeter, shift;  // relative
};

CapErrors measure_cap(const bench::Bench& bench, int cells, double epsilon, double start,
                      bench::Table& table) {
  const Equilibrium state = relaxed_cap(bench, bench.space("sphere", cells), epsilon, start, 30);
  if (state.rafts.rafts.size() != 1) throw std::runtime_error("a cap did not remain one raft");
  const double mass = state.problem->mass(state.y);
  const double angle = std::acos(1 - state.rafts.area / (2 * kPi));
  const double theory = cap_angle(mass, epsilon), shift = state.rafts.c_max - 1;
  const double perimeter = state.rafts.perimeter / (2 * kPi * std::sin(angle));
  const double shift_theory = gibbs_thomson(epsilon, theory);
  table.rows.push_back({mass / (4 * kPi), static_cast<double>(cells), epsilon, angle, theory,
                        perimeter, shift, shift_theory});
  return {std::fabs(angle / theory - 1), std::fabs(perimeter - 1),
          std::fabs(shift / shift_theory - 1)};
}

// The same number of cells across a boundary at either width: what is left is theory's own error,
// ε² in the angle and ε in the shift.
void measure_caps(const bench::Bench& bench, StudyReport& report) {
  bench::Table table{"caps",
                     {"raft fraction", "cells", "epsilon", "angle", "theory",
                      "perimeter/(2 pi sin)", "shift of c", "theory of shift"},
                     {}};
  const int cells = bench.quick() ? 128 : 256;
  const double epsilon = bench.quick() ? 0.06 : 0.03;
  for (const double start : {0.95, 1.2}) {
    const CapErrors coarse = measure_cap(bench, cells / 2, 2 * epsilon, start, table);
    const CapErrors fine = measure_cap(bench, cells, epsilon, start, table);
    const std::string cap = formatted("cap of angle %.2f: ", start);
    report.claims.push_back(claim_at_most(cap + "relative error of the angle", fine.angle, 0.01));
    report.claims.push_back(
        claim_at_most(cap + "error of the angle / error at twice epsilon (theory: 1/4)",
                      fine.angle / coarse.angle, 0.4));
    report.claims.push_back(
        claim_at_most(cap + "relative error of the shift of c (Gibbs-Thomson)", fine.shift, 0.1));
    report.claims.push_back(claim_at_most(
        cap + "relative error of the level curve against 2 pi sin(angle)", fine.perimeter, 0.001));
  }
  report.tables.push_back(table);
}

constexpr double kTight = 1e-5;  // of the tolerances

struct Dissolution {
  double time = 0;      // when the smaller raft is gone
  bool shrinks = true;  // the smaller one, in every step after the first relaxation
};

// Within the last step, by its interpolation.
double moment_of_merging(const time::Integrator& integrator, const problem::CahnHilliard& problem,
                         const observables::RaftFinder& finder) {
  double two = integrator.time() - integrator.step(), one = integrator.time();
  Vec y(problem.size());
  for (int i = 0; i < 30; ++i) {
    const double t = 0.5 * (two + one);
    bench::require(integrator.interpolate(t, y));
    (finder.find(problem.c_of(y), 0.5).rafts.size() == 2 ? two : one) = t;
  }
  return one;
}

Dissolution dissolve(const bench::Bench& bench, int cells, double tolerance) {
  constexpr double kEnd = 20;
  const bench::SpacePtr space = bench.space("sphere", cells);
  const bench::ProblemPtr problem = bench.problem(space, bench::bench_model(kMobility, 0.1));
  problem::InitialRequest request;
  request.caps = {{Point(0.3, 0.2, 1), 0.9}, {Point(-0.1, 0.2, -1), 0.45}};
  const time::IntegratorPtr integrator = bench.default_integrator(*problem, tolerance);
  const observables::RaftFinder finder(space);
  Dissolution found;
  double before = 0;
  bench::advance_to(*integrator, bench::initial_state(*problem, "caps", request), kEnd, [&] {
    const observables::RaftReport rafts = finder.find(problem->c_of(integrator->state()), 0.5);
    if (found.time > 0) return;
    if (rafts.rafts.size() != 2) {
      found.time = moment_of_merging(*integrator, *problem, finder);
      return;
    }
    const double area = rafts.rafts.back().area;
    if (before > 0 && !(area < before)) found.shrinks = false;
    if (integrator->time() > 1) before = area;
  });
  if (found.time == 0) throw std::runtime_error("the smaller of two rafts did not dissolve");
  return found;
}

void measure_dissolution(const bench::Bench& bench, StudyReport& report) {
  bench::Table table{"dissolution", {"cells", "tolerance", "time", "smaller one shrinks"}, {}};
  const int finest = bench.quick() ? 64 : 256;
  statistics::Points levels;
  bool shrinks = true;
  const auto measured = [&](int cells, double tolerance) {
    const Dissolution found = dissolve(bench, cells, tolerance);
    shrinks = shrinks && found.shrinks;
    table.rows.push_back(
        {static_cast<double>(cells), tolerance, found.time, found.shrinks ? "yes" : "no"});
    return found.time;
  };
  for (int cells = finest / 4; cells <= finest; cells *= 2)
    levels.emplace_back(cells, measured(cells, kTight));
  const double loose = measured(finest / 2, 10 * kTight);
  report.tables.push_back(table);
  const double fine = std::fabs(levels[2].second - levels[1].second);
  const double coarse = std::fabs(levels[1].second - levels[0].second);
  report.claims.push_back(claim_between(
      "the smaller of two rafts shrinks in every step after t = 1 (1 means yes)", shrinks, 1, 1));
  report.claims.push_back(claim_at_most(
      "time until it vanishes: change by the last halving of h / change by the halving before",
      fine / coarse, 0.4));
  report.claims.push_back(
      claim_at_most("time until it vanishes: relative change from tolerance 1e-4 to 1e-5",
                    std::fabs(loose / levels[1].second - 1), 0.01));
}

StudyReport run(const bench::Bench& bench) {
  StudyReport report;
  report.notes = {
      "Caps relax with constant mobility, to t = 30 for caps and t = 100 for a boundary at the "
      "equator. The boundary is compared with the equilibrium on the sphere, which is solved in "
      "one dimension. Caps are compared with the limit of a sharp boundary and its first "
      "correction in epsilon."};
  measure_boundary(bench, report);
  bench.progress(0.2);
  measure_directions(bench, report);
  bench.progress(0.3);
  measure_caps(bench, report);
  bench.progress(0.6);
  measure_dissolution(bench, report);
  return report;
}

}  // namespace

StudyEntry equilibria_study() {
  return {"equilibria", "a boundary, caps and two rafts against the theory of equilibria", run};
}

}  // namespace traceraft::studies
