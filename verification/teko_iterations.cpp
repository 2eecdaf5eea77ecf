// Iterations of Belos with Teko's block preconditioners, ours and the stock ones, over meshes, step
// sizes and widths of the boundary.
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "backends/list.hpp"
#include "kernel/core/random.hpp"
#include "kernel/problem/cahn_hilliard.hpp"
#include "kernel/problem/initial_data.hpp"
#include "verification/studies.hpp"

namespace traceraft {
namespace {

constexpr double kTolerance = 1e-8;
constexpr double kLargestShift = 1e5, kSmallestShift = 1e-3;  // D/R²: eight decades
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
    const double z = 2 * draw(0) - 1, around = 2 * std::acos(-1.0) * draw(1);
    const double r = std::sqrt(1 - z * z);
    caps.push_back({Point(r * std::cos(around), r * std::sin(around), z), 0.1 + 0.15 * draw(2)});
  }
  return caps;
}

void require(const Status& status) {
  if (!status.ok()) throw std::runtime_error("teko: " + status.why);
}

Vec state_of(const CahnHilliard& problem, int state) {
  InitialRequest request;
  request.epsilon = problem.model().epsilon;
  request.caps = rafts(state);
  Vec y = Vec::Zero(problem.size()), ydot = y;
  y.head(problem.block_size()) = make_initial_field("caps", problem.space(), request);
  require(problem.consistent_initial_state(0, y, ydot));
  return y;
}

// −1: more than 200.
int iterations(const CahnHilliard& problem, const Vec& y, double shift, const Variant& variant) {
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

StudyReport run(const StudyRequest& request) {
  StudyReport report;
  // variant: 0 two-solve with muelu-ilu, 1 with muelu, 2 block Gauss–Seidel, 3 block LU.
  report.columns = {"variant", "cells", "epsilon", "two_rafts"};
  for (double shift = kLargestShift; shift > 0.9 * kSmallestShift; shift /= 10)
    report.columns.push_back("s=1e" + std::to_string(std::lround(std::log10(shift))));
  if (!linear_solvers().find("teko").built) {
    report.skipped = "Trilinos was not built in";
    return report;
  }
  double most = 0;
  bool failed = false;
  for (int cells = request.quick ? 32 : 64; cells <= (request.quick ? 32 : 256); cells *= 2) {
    const auto space = std::make_shared<SurfaceSpace>(*make_surface("sphere"), cells,
                                                      std::make_shared<ThreadTeam>(1),
                                                      std::make_shared<SerialCommunicator>());
    for (int variant = 0; variant < 4; ++variant) {
      // The stock ones take long and do not get better.
      if (variant > 1 && (request.quick || cells > 64)) continue;
      for (const double epsilon : {0.01, 0.02, 0.05})
        for (int state = 0; state < 2; ++state) {
          CahnHilliardModel model;
          model.mobility = make_mobility("degenerate");
          model.epsilon = epsilon;
          const CahnHilliard problem(space, model);
          const Vec y = state_of(problem, state);
          std::vector<double> row = {static_cast<double>(variant), static_cast<double>(cells),
                                     epsilon, static_cast<double>(state)};
          for (double shift = kLargestShift; shift > 0.9 * kSmallestShift; shift /= 10) {
            row.push_back(iterations(problem, y, shift, kVariants[variant]));
            if (variant > 0) continue;
            failed = failed || row.back() < 0;
            most = std::max(most, row.back());
          }
          report.rows.push_back(row);
        }
    }
  }
  report.claims = {{"two-solve, one V-cycle each: most to 1e-8", most, 1, kGoal},
                   {"systems it does not solve", failed ? 1.0 : 0.0, 0, 0}};
  return report;
}

}  // namespace

StudyEntry teko_iterations_study() {
  return {"teko", "Belos iterations with Teko's block preconditioners (needs Trilinos)", run};
}

}  // namespace traceraft
