#include "verification/bench/bench.hpp"

#include <atomic>
#include <stdexcept>

#include "backends/list.hpp"

namespace traceraft::bench {

Bench::Bench(BenchRequest request_) : request(std::move(request_)) {
  if (!request.integrator.empty()) (void)backends::integrators().find(request.integrator);
  if (!request.linear_solver.empty()) (void)backends::linear_solvers().find(request.linear_solver);
}

void Bench::progress(double share) const {
  if (request.progress) request.progress(share);
}

std::vector<std::string> Bench::integrators() const {
  if (!request.integrator.empty()) return {request.integrator};
  return backends::integrators().names();
}

std::vector<std::string> Bench::linear_solvers() const {
  if (!request.linear_solver.empty()) return {request.linear_solver};
  return backends::built_linear_solvers();
}

std::vector<std::string> Bench::linear_solvers_on_ranks() const {
  std::vector<std::string> names;
  if (!request.run_program) return names;
  for (const std::string& name : linear_solvers())
    if (backends::linear_solvers().find(name).distributed) names.push_back(name);
  return names;
}

std::string Bench::integrator() const {
  return request.integrator.empty() ? "ida" : request.integrator;
}

std::string Bench::linear_solver() const {
  return request.linear_solver.empty() ? "block" : request.linear_solver;
}

SpacePtr Bench::space(geometry::LevelSetPtr surface, int cells, int threads) const {
  return std::make_shared<const fem::SurfaceSpace>(std::move(surface), cells,
                                                   std::make_shared<ThreadTeam>(threads),
                                                   std::make_shared<SerialCommunicator>());
}

SpacePtr Bench::space(const std::string& surface, int cells) const {
  return space(geometry::make_surface(surface), cells, request.threads);
}

ProblemPtr Bench::problem(SpacePtr space, problem::CahnHilliardModel model) const {
  return std::make_unique<const problem::CahnHilliard>(std::move(space), std::move(model));
}

time::IntegratorPtr Bench::make_integrator(const problem::DaeProblem& problem,
                                           const fem::SurfaceSpace& space, const std::string& name,
                                           const std::string& linear_solver,
                                           const time::IntegratorSettings& settings) const {
  return backends::integrators().find(name).make(
      problem, backends::choose_linear_solver(linear_solver, space), space.team, settings);
}

time::IntegratorPtr Bench::default_integrator(const problem::CahnHilliard& problem,
                                              double tolerance) const {
  time::IntegratorSettings settings;
  settings.tolerance =
      tolerance > 0 ? tolerance : backends::integrators().find(integrator()).tolerance;
  return make_integrator(problem, problem.space(), integrator(), linear_solver(), settings);
}

void Bench::in_parallel(int count, const std::function<void(int)>& job, Part of) const {
  // Solvers that work on ranks keep the state of their library for the whole process.
  const bool alone = backends::linear_solvers().find(linear_solver()).distributed;
  const ThreadTeam team(alone ? 1 : request.threads);
  std::atomic<int> next{0}, done{0};
  team.run([&](int part) {
    for (int k = next++; k < count; k = next++) {
      job(k);
      ++done;
      if (part == 0) progress(of.from + (of.to - of.from) * static_cast<double>(done) / count);
    }
  });
}

problem::CahnHilliardModel bench_model(const std::string& mobility, double epsilon) {
  problem::CahnHilliardModel model;
  model.mobility = physics::make_mobility(mobility);
  model.epsilon = epsilon;
  return model;
}

StartState consistent_state(const problem::CahnHilliard& problem, VecView c) {
  StartState start{Vec::Zero(problem.size()), Vec::Zero(problem.size())};
  start.y.head(problem.block_size()) = c;
  require(problem.consistent_initial_state(0, start.y, start.ydot));
  return start;
}

StartState initial_state(const problem::CahnHilliard& problem, const std::string& initial,
                         problem::InitialRequest request) {
  request.epsilon = problem.model().epsilon;
  request.well = problem.model().well;
  return consistent_state(problem, problem::make_initial_field(initial, problem.space(), request));
}

void advance_to(time::Integrator& integrator, const StartState& start, double t_end,
                const std::function<void()>& on_step) {
  require(integrator.start(0, start.y, start.ydot, t_end));
  while (integrator.time() < t_end) {
    require(integrator.advance());
    if (on_step) on_step();
  }
}

void require(const Status& status) {
  if (!status.ok()) throw std::runtime_error(status.why);
}

}  // namespace traceraft::bench
