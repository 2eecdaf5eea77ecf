#include "verification/bench/bench.hpp"

#include <atomic>
#include <stdexcept>

#include "backends/list.hpp"

namespace traceraft {

Bench::Bench(BenchRequest request_) : request(std::move(request_)) {
  if (!request.integrator.empty()) (void)traceraft::integrators().find(request.integrator);
  if (!request.linear_solver.empty()) (void)traceraft::linear_solvers().find(request.linear_solver);
}

void Bench::progress(double share) const {
  if (request.progress) request.progress(share);
}

std::vector<std::string> Bench::integrators() const {
  if (!request.integrator.empty()) return {request.integrator};
  return traceraft::integrators().names();
}

std::vector<std::string> Bench::linear_solvers() const {
  if (!request.linear_solver.empty()) return {request.linear_solver};
  return built_linear_solvers();
}

std::vector<std::string> Bench::linear_solvers_on_ranks() const {
  std::vector<std::string> names;
  if (!request.run_program) return names;
  for (const std::string& name : linear_solvers())
    if (traceraft::linear_solvers().find(name).distributed) names.push_back(name);
  return names;
}

std::string Bench::integrator() const {
  return request.integrator.empty() ? "ida" : request.integrator;
}

std::string Bench::linear_solver() const {
  return request.linear_solver.empty() ? "block" : request.linear_solver;
}

SpacePtr Bench::space(const LevelSet& surface, int cells, int threads) const {
  return std::make_shared<const SurfaceSpace>(surface, cells, std::make_shared<ThreadTeam>(threads),
                                              std::make_shared<SerialCommunicator>());
}

SpacePtr Bench::space(const std::string& surface, int cells) const {
  return space(*make_surface(surface), cells, request.threads);
}

ProblemPtr Bench::problem(SpacePtr space, CahnHilliardModel model) const {
  return std::make_unique<const CahnHilliard>(std::move(space), std::move(model));
}

IntegratorPtr Bench::make_integrator(const DaeProblem& problem, const SurfaceSpace& space,
                                     const std::string& name, const std::string& linear_solver,
                                     const IntegratorSettings& settings) const {
  return traceraft::integrators().find(name).make(
      problem, choose_linear_solver(linear_solver, space), space.team, settings);
}

IntegratorPtr Bench::default_integrator(const CahnHilliard& problem, double tolerance) const {
  IntegratorSettings settings;
  settings.tolerance =
      tolerance > 0 ? tolerance : traceraft::integrators().find(integrator()).tolerance;
  return make_integrator(problem, problem.space(), integrator(), linear_solver(), settings);
}

void Bench::in_parallel(int count, const std::function<void(int)>& job, Part of) const {
  // What works on ranks keeps the state of its library for the whole process.
  const bool alone = traceraft::linear_solvers().find(linear_solver()).distributed;
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

CahnHilliardModel bench_model(const std::string& mobility, double epsilon) {
  CahnHilliardModel model;
  model.mobility = make_mobility(mobility);
  model.epsilon = epsilon;
  return model;
}

StartState consistent_state(const CahnHilliard& problem, VecView c) {
  StartState start{Vec::Zero(problem.size()), Vec::Zero(problem.size())};
  start.y.head(problem.block_size()) = c;
  require(problem.consistent_initial_state(0, start.y, start.ydot));
  return start;
}

StartState initial_state(const CahnHilliard& problem, const std::string& initial,
                         InitialRequest request) {
  request.epsilon = problem.model().epsilon;
  request.well = problem.model().well;
  return consistent_state(problem, make_initial_field(initial, problem.space(), request));
}

void advance_to(Integrator& integrator, const StartState& start, double t_end,
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

}  // namespace traceraft
