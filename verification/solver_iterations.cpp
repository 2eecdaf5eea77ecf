// GMRES iterations of the block solver with fresh factors, over meshes, step sizes and widths.
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "backends/list.hpp"
#include "kernel/problem/cahn_hilliard.hpp"
#include "kernel/problem/initial_data.hpp"
#include "verification/studies.hpp"

namespace traceraft {
namespace {

// What integrators ask for: euler, with the stabilised tangent, and ida, with the exact one.
constexpr double kTolerance[2] = {1e-4, 1e-2};
// The shift of the fastest and of the slowest step, in units of D/R²: eight decades.
constexpr double kLargestShift = 1e5, kSmallestShift = 1e-3;
// The exact Jacobian of a step far longer than the state allows is indefinite. What is claimed of
// it is for steps up to twice the one that ida takes there, as it at most doubles a step.
constexpr double kLongestStep = 2;

void require(const Status& status) {
  if (!status.ok()) throw std::runtime_error("iterations: " + status.why);
}

enum class State { coarsening, late };  // many rafts; one large and one small

struct Sample {
  Vec y;
  double step;  // that ida takes there
};

Sample state_at(const CahnHilliard& problem, State state, double t_end) {
  const SurfaceSpace& space = problem.space();
  InitialRequest request;
  request.raft_fraction = 0.3;
  request.noise_cells = 16;
  request.epsilon = problem.model().epsilon;
  request.caps = {{Point(0, 0, 1), 0.9}, {Point(1, 2, -3).normalized(), 0.4}};
  Vec y = Vec::Zero(problem.size()), ydot = Vec::Zero(problem.size());
  y.head(problem.block_size()) =
      make_initial_field(state == State::late ? "caps" : "noise", space, request);
  require(problem.consistent_initial_state(0, y, ydot));
  IntegratorSettings settings;
  settings.tolerance = 1e-2;
  const IntegratorPtr ida = integrators().find("ida").make(
      problem, choose_linear_solver("block", space), space.team, settings);
  require(ida->start(0, y, ydot, t_end));
  while (ida->time() < t_end) require(ida->advance());
  return {ida->state(), ida->next_step()};
}

// −F(y, 0): what the first correction of a step from y solves with.
Vec right_side(const CahnHilliard& problem, const Vec& y) {
  Vec r(problem.size());
  require(problem.residual(0, y, Vec::Zero(y.size()), r));
  return -r;
}

int iterations(const CahnHilliard& problem, const Vec& y, const Vec& b, double shift,
               Tangent tangent) {
  const LinearSolverPtr solver = linear_solvers().find("block").make(problem.space(), {})(1);
  BlockJacobian J = problem.make_jacobian();
  require(problem.jacobian(0, y, Vec::Zero(y.size()), shift, tangent, J));
  require(solver->setup(J));
  Vec x = Vec::Zero(b.size());
  const SolveReport report = solver->solve(J, b, x, kTolerance[tangent == Tangent::exact]);
  return report.status.ok() ? report.iterations : -1;
}

StudyReport run(const StudyRequest& request) {
  StudyReport report;
  // late 0: while rafts coarsen, 1: late. exact 0: stabilised tangent, 1: exact. −1 iterations: a
  // fallback would be needed.
  report.columns = {"late", "exact", "cells", "epsilon", "ida_step"};
  for (double shift = kLargestShift; shift > 0.9 * kSmallestShift; shift /= 10)
    report.columns.push_back("s=1e" + std::to_string(std::lround(std::log10(shift))));
  const auto team = std::make_shared<ThreadTeam>(2);
  double most[2] = {0, 0};
  bool fallback = false;
  for (int cells = 32; cells <= (request.quick ? 64 : 256); cells *= 2) {
    const auto space = std::make_shared<SurfaceSpace>(*make_surface("sphere"), cells, team,
                                                      std::make_shared<SerialCommunicator>());
    for (const double epsilon : {0.01, 0.02, 0.05}) {
      CahnHilliardModel model;
      model.mobility = make_mobility("degenerate");
      model.epsilon = epsilon;
      const CahnHilliard problem(space, model);
      for (const State state : {State::coarsening, State::late}) {
        const Sample sample = state_at(problem, state, 5);
        const Vec b = right_side(problem, sample.y);
        for (const Tangent tangent : {Tangent::stabilised, Tangent::exact}) {
          const int exact = tangent == Tangent::exact;
          std::vector<double> row = {state == State::late ? 1.0 : 0.0, static_cast<double>(exact),
                                     static_cast<double>(cells), epsilon, sample.step};
          for (double shift = kLargestShift; shift > 0.9 * kSmallestShift; shift /= 10) {
            row.push_back(iterations(problem, sample.y, b, shift, tangent));
            if (exact && 1 / shift > kLongestStep * sample.step) continue;
            fallback = fallback || row.back() < 0;
            most[exact] = std::max(most[exact], row.back());
          }
          report.rows.push_back(row);
        }
      }
    }
  }
  report.claims = {{"stabilised tangent: most iterations to 1e-4", most[0], 1, 25},
                   {"exact, to 2 x ida's step: most to 1e-2", most[1], 1, 25},
                   {"solves that need the fallback", fallback ? 1.0 : 0.0, 0, 0}};
  return report;
}

}  // namespace

StudyEntry solver_iterations_study() {
  return {"iterations", "GMRES iterations over meshes, shifts and widths of the boundary", run};
}

}  // namespace traceraft
