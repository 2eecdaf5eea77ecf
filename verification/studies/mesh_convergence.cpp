// Orders of convergence in the mesh size h: stationary problem and full time-dependent system.
#include "verification/analytic/manufactured.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

constexpr double kEnd = 0.5;
// The tolerance of the integration in time. Errors of the mesh are a hundred times as large as its
// errors.
constexpr double kTolerance = 1e-6;

struct Quantity {
  const char* name;
  double order;
};
constexpr Quantity kQuantities[] = {{"stationary problem, L2", 2}, {"stationary problem, H1", 1},
                                    {"full system, c in L2", 2},   {"full system, c in H1", 1},
                                    {"full system, mu in L2", 2},  {"full system, mu in H1", 1}};

std::array<double, 6> errors(const bench::Bench& bench, const std::string& surface, int cells) {
  const bench::SpacePtr space = bench.space(surface, cells);
  const bench::ErrorNorms stationary =
      analytic::stationary_error(*space, analytic::surface_function(surface));
  const analytic::ManufacturedCahnHilliard manufactured(bench, space, surface, 0.3);
  const problem::CahnHilliard& problem = *manufactured.problem;
  const time::IntegratorPtr integrator = bench.default_integrator(problem, kTolerance);
  bench::advance_to(*integrator, manufactured.initial_state(), kEnd);
  const Vec& y = integrator->state();
  const bench::ErrorNorms c = bench::error_norms(*space, problem.c_of(y), manufactured.c(kEnd));
  const bench::ErrorNorms mu = bench::error_norms(*space, problem.mu_of(y), manufactured.mu(kEnd));
  return {stationary.l2, stationary.h1, c.l2, c.h1, mu.l2, mu.h1};
}

StudyReport run(const bench::Bench& bench) {
  StudyReport report;
  report.notes = {
      "The stationary problem is -Laplace(u) + u = f with the solution u = xyz. The full system "
      "has the solution c = 1/2 + cos(t) xyz/4, to t = 0.5, and degenerate mobility. The order is "
      "that between the two finest meshes. Its uncertainty is the change from the pair of meshes "
      "before."};
  bench::Table table{"errors", {"surface", "cells", "h"}, {}};
  for (const char* column : {"L2", "H1", "c_L2", "c_H1", "mu_L2", "mu_H1"})
    table.columns.push_back(column);
  bench::Chart chart{
      "Errors of c and mu against the mesh size", "h", "error in L2", true, true, {}};
  const std::vector<std::pair<std::string, int>> surfaces = {
      {"sphere", 8}, {"ellipsoid", 16}, {"torus", 16}};
  const int finest = bench.quick() ? 32 : 128;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const auto& [surface, coarsest] = surfaces[s];
    std::array<statistics::Points, 6> levels;
    for (int cells = coarsest; cells <= finest; cells *= 2) {
      const double h = 10.0 / 3 / cells;
      const std::array<double, 6> e = errors(bench, surface, cells);
      std::vector<bench::Cell> row = {surface, static_cast<double>(cells), h};
      for (std::size_t q = 0; q < e.size(); ++q) {
        row.push_back(e[q]);
        levels[q].emplace_back(h, e[q]);
      }
      table.rows.push_back(row);
      bench.progress((static_cast<double>(s) + static_cast<double>(cells) / finest) / 3);
    }
    chart.series.push_back({surface + ", c", levels[2]});
    chart.series.push_back({surface + ", mu", levels[4]});
    for (std::size_t q = 0; q < levels.size(); ++q)
      report.claims.push_back(claim_order(surface + ": order, " + kQuantities[q].name, levels[q],
                                          kQuantities[q].order, 0.25));
  }
  report.tables = {table};
  report.charts = {chart};
  return report;
}

}  // namespace

StudyEntry mesh_convergence_study() {
  return {"convergence",
          "orders of convergence in the mesh size, by manufactured solutions on three surfaces",
          run};
}

}  // namespace traceraft::studies
