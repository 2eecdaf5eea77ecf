// Iterations of Belos with Teko's block preconditioners, ours and the stock ones, over meshes, step
// sizes and widths of the boundary.
#include <algorithm>
#include <cmath>

#include "backends/list.hpp"
#include "kernel/core/random.hpp"
#include "verification/bench.hpp"
#include "verification/shift_range.hpp"
#include "verification/studies.hpp"

namespace traceraft {
namespace {

constexpr double kTolerance = 1e-8;
constexpr double kGoal = 30;

struct Variant {
  const char *preconditioner, *inverse;
};
constexpr Variant kVariants[] = {{"two-solve", "muelu-ilu"},
                                 {"two-solve", "muelu"},
                                 {"gauss-seidel", "muelu-ilu"},
                                 {"block-lu", "muelu-ilu"}};

// 0: thirty rafts, 1: a large and a small one. Equilibrium profiles, so that no mesh needs a run
// before it.
std::vector<CapRaft> rafts(int state) {
  if (state == 1) return {{Point(0, 0, 1), 0.9}, {Point(1, 2, -3).normalized(), 0.4}};
  std::vector<CapRaft> caps;
  for (std::uint64_t k = 0; k < 30; ++k) {
    const auto draw = [&](std::uint64_t which) { return uniform_random(1, 50 + which, k); };
    const double z = 2 * draw(0) - 1, around = 2 * kPi * draw(1);
    const double r = std::sqrt(1 - z * z);
    caps.push_back({Point(r * std::cos(around), r * std::sin(around), z), 0.1 + 0.15 * draw(2)});
  }
  return caps;
}

Vec state_of(const CahnHilliard& problem, int state) {
  InitialRequest request;
  request.caps = rafts(state);
  return initial_state(problem, "caps", request).y;
}

// −1: more than 200.
double iterations(const CahnHilliard& problem, const Vec& y, double shift, const Variant& variant) {
  const LinearSolverPtr solver = linear_solvers().find("teko").make(
      problem.space(),
      {{"preconditioner", variant.preconditioner}, {"inverse", variant.inverse}})(1);
  BlockJacobian J = problem.make_jacobian();
  Vec b(problem.size()), x = Vec::Zero(problem.size());
  require(problem.residual(0, y, Vec::Zero(y.size()), b));
  require(problem.jacobian(0, y, Vec::Zero(y.size()), shift, Tangent::stabilised, J));
  if (!solver->setup(J).ok()) return -1;
  const SolveReport report = solver->solve(J, -b, x, kTolerance);
  return report.status.ok() ? report.iterations : -1;
}

struct Most {
  double iterations = 0, failures = 0;
};

void measure(const Bench& bench, const SpacePtr& space, const Variant& variant, Table& table,
             Most& most) {
  for (const double epsilon : {0.01, 0.02, 0.05})
    for (int state = 0; state < 2; ++state) {
      const ProblemPtr problem = bench.problem(space, bench_model("degenerate", epsilon));
      const Vec y = state_of(*problem, state);
      std::vector<Cell> row = {std::string(variant.preconditioner) + ", " + variant.inverse,
                               static_cast<double>(space->mesh.cube.cells), epsilon,
                               state == 1 ? "two rafts" : "thirty rafts"};
      for (const double shift : shift_range()) {
        const double count = iterations(*problem, y, shift, variant);
        row.push_back(count);
        if (count < 0) ++most.failures;
        most.iterations = std::max(most.iterations, count);
      }
      table.rows.push_back(row);
    }
}

StudyReport measure_meshes(const Bench& bench, int coarsest, int finest) {
  StudyReport report;
  if (!linear_solvers().find("teko").built) {
    report.skipped = "Trilinos was not built in";
    return report;
  }
  Table table{"iterations", {"preconditioner, inverse", "cells", "epsilon", "state"}, {}};
  for (const double shift : shift_range()) table.columns.push_back(shift_label(shift));
  Most most[std::size(kVariants)];
  for (int cells = coarsest; cells <= finest; cells *= 2) {
    const SpacePtr space = bench.space(*make_surface("sphere"), cells, 1);
    for (const Variant& variant : kVariants) {
      const bool stock = variant.preconditioner != std::string("two-solve");
      // The stock ones take long and do not get better.
      if (stock && cells != 64) continue;
      if (&variant != kVariants && cells > 128) continue;
      measure(bench, space, variant, table, most[&variant - kVariants]);
    }
    bench.progress(static_cast<double>(cells * cells) / (finest * finest));
  }
  report.notes = {
      "Belos to 1e-8, fresh preconditioner, stabilised tangent, degenerate mobility; s is the "
      "shift in D/R^2; -1: more than 200."};
  report.tables = {table};
  report.claims = {
      claim_between("two-solve, muelu-ilu: most to 1e-8", most[0].iterations, 1, kGoal),
      claim_at_most("two-solve, muelu-ilu: systems it does not solve", most[0].failures, 0)};
  if (finest <= 128)
    report.claims.push_back(claim_at_most("two-solve, muelu (default): systems it does not solve",
                                          most[1].failures, 0));
  return report;
}

}  // namespace

StudyEntry teko_iterations_study() {
  return {"teko", "Belos iterations with Teko's block preconditioners (needs Trilinos)",
          [](const Bench& bench) {
            return bench.quick() ? measure_meshes(bench, 32, 32) : measure_meshes(bench, 64, 128);
          }};
}

StudyEntry large_teko_iterations_study() {
  return {"teko-large", "the same on fine meshes: half an hour, --quick ten minutes",
          [](const Bench& bench) { return measure_meshes(bench, 256, bench.quick() ? 256 : 512); },
          true};
}

}  // namespace traceraft
