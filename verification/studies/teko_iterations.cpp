// Iterations of Belos with Teko's block preconditioners, ours and the stock ones, over meshes, step
// sizes and widths of the boundary.
#include <algorithm>
#include <cmath>

#include "backends/list.hpp"
#include "kernel/core/random.hpp"
#include "verification/bench/bench.hpp"
#include "verification/bench/shift_range.hpp"
#include "verification/statistics/random_streams.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

constexpr double kTolerance = 1e-8;
constexpr double kGoal = 30;

struct Variant {
  const char *preconditioner, *inverse;
};
enum { kOwn, kDefault, kGaussSeidel, kBlockLu };
constexpr Variant kVariants[] = {{"two-solve", "muelu-ilu"},
                                 {"two-solve", "muelu"},
                                 {"gauss-seidel", "muelu-ilu"},
                                 {"block-lu", "muelu-ilu"}};

// 0: thirty rafts, 1: a large and a small one. Equilibrium profiles, so that no mesh needs a run
// before it.
std::vector<problem::CapRaft> rafts(int state) {
  if (state == 1) return {{Point(0, 0, 1), 0.9}, {Point(1, 2, -3).normalized(), 0.4}};
  std::vector<problem::CapRaft> caps;
  for (std::uint64_t k = 0; k < 30; ++k) {
    const auto draw = [&](std::uint64_t which) {
      return uniform_random(statistics::fixed_seed::test_vectors, 50 + which, k);
    };
    caps.push_back({uniform_direction(draw(0), draw(1)), 0.1 + 0.15 * draw(2)});
  }
  return caps;
}

Vec state_of(const problem::CahnHilliard& problem, int state) {
  problem::InitialRequest request;
  request.caps = rafts(state);
  return bench::initial_state(problem, "caps", request).y;
}

// −1: more than 200.
double iterations(const problem::CahnHilliard& problem, const Vec& y, double shift,
                  const Variant& variant) {
  const linear::LinearSolverPtr solver = backends::linear_solvers().find("teko").make(
      problem.space(),
      {{"preconditioner", variant.preconditioner}, {"inverse", variant.inverse}})(1);
  linear::BlockJacobian J = problem.make_jacobian();
  Vec b(problem.size()), x = Vec::Zero(problem.size());
  bench::require(problem.residual(0, y, Vec::Zero(y.size()), b));
  bench::require(
      problem.jacobian(0, y, Vec::Zero(y.size()), shift, linear::Tangent::stabilised, J));
  if (!solver->setup(J).ok()) return -1;
  const linear::SolveReport report = solver->solve(J, -b, x, kTolerance);
  return report.status.ok() ? report.iterations : -1;
}

struct Most {
  double iterations = 0, failures = 0;
};

void measure(const bench::Bench& bench, const bench::SpacePtr& space, const Variant& variant,
             bench::Table& table, Most& most) {
  for (const double epsilon : {0.01, 0.02, 0.05})
    for (int state = 0; state < 2; ++state) {
      const bench::ProblemPtr problem =
          bench.problem(space, bench::bench_model("degenerate", epsilon));
      const Vec y = state_of(*problem, state);
      std::vector<bench::Cell> row = {std::string(variant.preconditioner) + ", " + variant.inverse,
                                      static_cast<double>(space->mesh.cube.cells), epsilon,
                                      state == 1 ? "two rafts" : "thirty rafts"};
      for (const double shift : bench::shift_range()) {
        const double count = iterations(*problem, y, shift, variant);
        row.push_back(count);
        if (count < 0) ++most.failures;
        most.iterations = std::max(most.iterations, count);
      }
      table.rows.push_back(row);
    }
}

// On which meshes which of them are measured.
struct Mesh {
  int cells;
  std::vector<int> variants;
};

StudyReport measure_meshes(const bench::Bench& bench, const std::vector<Mesh>& meshes) {
  StudyReport report;
  if (!backends::linear_solvers().find("teko").built) {
    report.skipped = "this build has no Trilinos";
    return report;
  }
  bench::Table table{"iterations", {"preconditioner, inverse", "cells", "epsilon", "state"}, {}};
  for (const double shift : bench::shift_range())
    table.columns.push_back(bench::shift_label(shift));
  Most most[std::size(kVariants)];
  const double finest = meshes.back().cells;
  for (const auto& [cells, variants] : meshes) {
    const bench::SpacePtr space = bench.space(geometry::make_surface("sphere"), cells, 1);
    for (const int variant : variants)
      measure(bench, space, kVariants[variant], table, most[variant]);
    bench.progress(cells * cells / (finest * finest));
  }
  report.notes = {
      "Numbers are iterations of Belos to a relative residual of 1e-8, with a fresh "
      "preconditioner, the stabilised tangent and degenerate mobility. The shift s is in units of "
      "D/R^2. The number -1 means more than 200 iterations."};
  report.tables = {table};
  report.claims = {
      claim_between("two-solve, muelu-ilu: most iterations to 1e-8", most[kOwn].iterations, 1,
                    kGoal),
      claim_at_most("two-solve, muelu-ilu: systems that are not solved", most[kOwn].failures, 0),
      claim_between("two-solve, muelu (default): most iterations to 1e-8",
                    most[kDefault].iterations, 1, 150),
      claim_at_most("two-solve, muelu (default): systems that are not solved",
                    most[kDefault].failures, 0)};
  return report;
}

StudyReport measure_daily(const bench::Bench& bench) {
  if (bench.quick()) return measure_meshes(bench, {{32, {kOwn, kDefault}}});
  // The stock ones take long and do not get better.
  return measure_meshes(bench, {{64, {kOwn, kDefault, kGaussSeidel, kBlockLu}}, {128, {kOwn}}});
}

StudyReport measure_large(const bench::Bench& bench) {
  std::vector<Mesh> meshes = {{128, {kDefault}}, {256, {kOwn}}};
  if (!bench.quick()) meshes.push_back({512, {kOwn}});
  return measure_meshes(bench, meshes);
}

}  // namespace

StudyEntry teko_iterations_study() {
  return {"teko", "Belos iterations with Teko's block preconditioners (needs Trilinos)",
          measure_daily};
}

StudyEntry large_teko_iterations_study() {
  return {"teko-large", "teko on fine meshes: takes half an hour, or ten minutes with --quick",
          measure_large, true};
}

}  // namespace traceraft::studies
