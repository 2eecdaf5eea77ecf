// The energy falls along solutions at the rate at which the flux dissipates it:
// dE/dt = −μᵀ (K_M(c) + ρ m S) μ, the discrete −∫ M |∇μ|².
#include <algorithm>
#include <cmath>

#include "backends/list.hpp"
#include "verification/bench/bench.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/statistics/sample.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

constexpr double kEpsilon = 0.2;

struct Setup {
  bench::ProblemPtr problem;
  bench::StartState start;

  Setup(const bench::Bench& bench, int cells)
      : problem(bench.problem(bench.space("sphere", cells),
                              bench::bench_model("degenerate", kEpsilon))) {
    problem::InitialRequest request;
    request.raft_fraction = 0.3;
    request.noise_cells = 8;
    start = bench::initial_state(*problem, "noise", request);
  }
};

// μᵀ (K_M + ρ m S) μ: at ẏ = 0 the first half of the residual is the flux alone.
double dissipation(const problem::CahnHilliard& problem, const Vec& y) {
  Vec r(problem.size());
  bench::require(problem.residual(0, y, Vec::Zero(y.size()), r));
  return problem.mu_of(y).dot(r.head(problem.block_size()));
}

struct Rises {
  double steps = 0, count = 0, largest = 0;  // relative to the initial energy
};

Rises rises_of(const bench::Bench& bench, const Setup& setup, const std::string& name, bool guarded,
               double t_end) {
  time::IntegratorSettings settings;
  settings.tolerance = backends::integrators().find(name).tolerance;
  settings.reject_energy_rises = guarded;
  const problem::CahnHilliard& problem = *setup.problem;
  const time::IntegratorPtr integrator =
      bench.make_integrator(problem, problem.space(), name, bench.linear_solver(), settings);
  Rises rises;
  const double initial = problem.energy(setup.start.y);
  double before = initial;
  bench::advance_to(*integrator, setup.start, t_end, [&] {
    const double after = problem.energy(integrator->state());
    ++rises.steps;
    // Roundoff of the terms, which cancel near equilibrium, is no rise.
    if (!(after <= before + 1e-12 * problem.energy_scale())) {
      ++rises.count;
      rises.largest = statistics::larger(rises.largest, (after - before) / initial);
    }
    before = after;
  });
  return rises;
}

void measure_decay(const bench::Bench& bench, StudyReport& report) {
  bench::Table table{"rises", {"integrator", "guard", "steps", "rises", "largest"}, {}};
  const Setup setup(bench, 32);
  for (const std::string& name : bench.integrators()) {
    for (const bool guarded : {false, true}) {
      const Rises rises = rises_of(bench, setup, name, guarded, bench.quick() ? 20 : 200);
      table.rows.push_back(
          {name, guarded ? "reject" : "off", rises.steps, rises.count, rises.largest});
      if (guarded)
        report.claims.push_back(claim_at_most(
            name + ", --energy-guard reject: steps that gain energy", rises.count, 0));
      else
        report.claims.push_back(
            claim_at_most(name + ", no guard: largest gain / initial energy", rises.largest, 1e-3));
    }
  }
  report.tables.push_back(table);
}

// |E(T) − E(0) + ∫ dissipation dt| / (E(0) − E(T)), the integral by the trapezoidal rule.
double identity_residual(const bench::Bench& bench, const Setup& setup, const Vec& y0,
                         const std::string& name, double span, int steps) {
  const problem::CahnHilliard& problem = *setup.problem;
  time::IntegratorSettings settings;
  settings.tolerance = 0.5;  // all steps of the size asked for
  settings.initial_step = settings.max_step = span / steps;
  settings.linear_tolerance = 1e-11;
  if (name == "ida") settings.method_options["maxord"] = 2;
  const time::IntegratorPtr integrator =
      bench.make_integrator(problem, problem.space(), name, bench.linear_solver(), settings);
  const bench::StartState start = bench::consistent_state(problem, problem.c_of(y0));
  double dissipated = 0, before = dissipation(problem, start.y), t = 0;
  bench::advance_to(*integrator, start, span, [&] {
    const double after = dissipation(problem, integrator->state());
    dissipated += 0.5 * (integrator->time() - t) * (before + after);
    before = after;
    t = integrator->time();
  });
  const double lost = problem.energy(start.y) - problem.energy(integrator->state());
  return std::fabs(lost - dissipated) / lost;
}

void measure_identity(const bench::Bench& bench, StudyReport& report) {
  const Setup setup(bench, 16);
  const problem::CahnHilliard& problem = *setup.problem;
  // From where the fastest modes of the noise have died out.
  const time::IntegratorPtr before = bench.default_integrator(problem, 1e-3);
  bench::advance_to(*before, setup.start, 1);
  const Vec y = before->state();

  // In space: the derivative of the energy along the consistent rate.
  const bench::StartState here = bench::consistent_state(problem, problem.c_of(y));
  const double step = 1e-4;
  const double slope =
      (problem.energy(here.y + step * here.ydot) - problem.energy(here.y - step * here.ydot)) /
      (2 * step);
  const double rate = dissipation(problem, here.y);
  report.claims.push_back(claim_at_most("dE/dt + dissipation at one state, relative",
                                        std::fabs(slope + rate) / rate, 1e-6));

  bench::Table table{"identity", {"integrator", "steps", "residual"}, {}};
  bench::Chart chart{
      "Energy lost against energy dissipated", "step", "relative difference", true, true, {}};
  const double span = 1;
  for (const std::string& name : bench.integrators()) {
    statistics::Points levels;
    for (int steps = 40; steps <= (bench.quick() ? 160 : 640); steps *= 2) {
      levels.emplace_back(span / steps, identity_residual(bench, setup, y, name, span, steps));
      table.rows.push_back({name, static_cast<double>(steps), levels.back().second});
    }
    // The trapezoidal rule has order 2 whatever the integrator has beyond that.
    report.claims.push_back(
        claim_order(name + ": order of the dissipation identity", levels, 2, 0.3));
    chart.series.push_back({name, levels});
  }
  report.tables.push_back(table);
  report.charts.push_back(chart);
}

StudyReport run(const bench::Bench& bench) {
  StudyReport report;
  report.notes = {
      "The runs have 30 % rafts from noise, epsilon = 0.2 R and degenerate mobility. Rises of the "
      "energy are measured on 32 cells, at each integrator's default tolerance. At 5e-3 instead of "
      "1e-3, rosenbrock may gain 1e-3 of the initial energy. The dissipation identity says that "
      "the energy falls by what the flux dissipates. Its order is measured with equal steps on 16 "
      "cells."};
  measure_decay(bench, report);
  bench.progress(0.5);
  measure_identity(bench, report);
  return report;
}

}  // namespace

StudyEntry energy_decay_study() {
  return {"energy", "the energy falls as fast as the flux dissipates it", run};
}

}  // namespace traceraft::studies
