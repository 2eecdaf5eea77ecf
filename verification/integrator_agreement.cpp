// All integrators approach the same solution, and keep its mass, with every linear solver.
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

constexpr double kEnd = 1;          // rafts have formed and begun to coarsen
constexpr double kTightest = 1e-6;  // of the tolerances

struct Problem {
  std::shared_ptr<const SurfaceSpace> space;
  std::unique_ptr<CahnHilliard> dae;
  Vec y, ydot;

  Problem() {
    space =
        std::make_shared<SurfaceSpace>(*make_surface("sphere"), 16, std::make_shared<ThreadTeam>(2),
                                       std::make_shared<SerialCommunicator>());
    CahnHilliardModel model;
    model.mobility = make_mobility("degenerate");
    model.epsilon = 0.2;
    dae = std::make_unique<CahnHilliard>(space, model);
    y = ydot = Vec::Zero(dae->size());
    InitialRequest request;
    request.raft_fraction = 0.4;
    y.head(dae->block_size()) = make_initial_field("noise", *space, request);
    if (!dae->consistent_initial_state(0, y, ydot).ok())
      throw std::runtime_error("agreement: no consistent initial state");
  }
};

Vec solve(const Problem& problem, const std::string& integrator, const std::string& solver,
          double tolerance) {
  IntegratorSettings settings;
  settings.tolerance = tolerance;
  settings.linear_tolerance = std::min(1e-4, tolerance);
  const IntegratorPtr method = integrators()
                                   .find(integrator)
                                   .make(*problem.dae, choose_linear_solver(solver, *problem.space),
                                         problem.space->team, settings);
  Status status = method->start(0, problem.y, problem.ydot, kEnd);
  while (status.ok() && method->time() < kEnd) status = method->advance();
  if (!status.ok()) throw std::runtime_error("agreement: " + integrator + ": " + status.why);
  return method->state();
}

StudyReport run(const StudyRequest& request) {
  const Problem problem;
  const std::vector<std::string> names = integrators().names();
  StudyReport report;
  report.columns = {"tolerance"};
  for (const std::string& name : names) report.columns.push_back(name);
  const double scale = problem.dae->norm(problem.y), mass = problem.dae->mass(problem.y);
  double drift = 0;
  const auto watch_mass = [&](const Vec& y) {
    drift = std::max(drift, std::fabs(problem.dae->mass(y) / mass - 1));
  };
  std::vector<Vec> tightest;
  for (const std::string& name : names) {
    tightest.push_back(solve(problem, name, "block", kTightest));
    watch_mass(tightest.back());
  }
  double apart = 0;
  for (const Vec& a : tightest)
    for (const Vec& b : tightest) apart = std::max(apart, problem.dae->norm(a - b) / scale);

  const Vec& reference = tightest[std::find(names.begin(), names.end(), "ida") - names.begin()];
  for (double tolerance = 1e-2; tolerance > (request.quick ? 5e-4 : 5e-6); tolerance /= 10) {
    std::vector<double> row = {tolerance};
    for (const std::string& name : names)
      row.push_back(problem.dae->norm(solve(problem, name, "block", tolerance) - reference) /
                    scale);
    report.rows.push_back(row);
  }
  for (const std::string& solver : built_linear_solvers())
    for (const std::string& name : names) watch_mass(solve(problem, name, solver, 1e-3));
  report.claims = {{"largest difference at tolerance 1e-6", apart, 0, 1e-5},
                   {"largest mass drift of any combination", drift, 0, 1e-12}};
  return report;
}

}  // namespace

StudyEntry integrator_agreement_study() {
  return {"agreement", "all integrators approach one solution and keep its mass", run};
}

}  // namespace traceraft
