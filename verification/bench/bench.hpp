// The bench that studies measure on: it makes spaces, models and integrators as a run does.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kernel/discs/disc_model.hpp"
#include "kernel/fem/refinement_rule.hpp"
#include "kernel/problem/cahn_hilliard.hpp"
#include "kernel/problem/initial_data.hpp"
#include "kernel/time/integrator.hpp"

namespace traceraft::bench {

using SpacePtr = std::shared_ptr<const fem::SurfaceSpace>;
using ProblemPtr = std::unique_ptr<const problem::CahnHilliard>;

// A run of the whole program, as its user would start it.
struct ProgramRun {
  double steps, mass_drift;
  Vec c;  // at the nodes, at the end
};
// `options` are those of `traceraft run`, in units of R and R²/D. Throws std::runtime_error if the
// run fails.
using RunProgram =
    std::function<ProgramRun(const std::vector<std::string>& options, int ranks, int nodes)>;

// The share of the whole that a part of a study takes, for the display of progress.
struct Part {
  double from = 0, to = 1;
};

struct BenchRequest {
  bool quick = false;         // coarser and shorter, for every day
  std::string integrator;     // "": a study's choice, or all of them where it compares
  std::string linear_solver;  // likewise
  int threads = 2;
  // Called now and then with the share of a study that is done, 0 to 1. May be empty.
  std::function<void(double)> progress = {};
  // Empty: studies do without runs on ranks.
  RunProgram run_program = {};
};

// Tests derive from it, break one part on purpose and see a study fail.
class Bench {
 public:
  explicit Bench(BenchRequest request);
  virtual ~Bench() = default;

  const BenchRequest request;
  bool quick() const { return request.quick; }
  void progress(double share) const;

  // Those that a comparing study compares.
  std::vector<std::string> integrators() const;
  std::vector<std::string> linear_solvers() const;
  // Those that work on ranks; none if the program cannot be run on them.
  std::vector<std::string> linear_solvers_on_ranks() const;
  // The integrator and the solver of a study that needs one.
  std::string integrator() const;
  std::string linear_solver() const;

  virtual SpacePtr space(geometry::LevelSetPtr surface, int cells, int threads) const;
  SpacePtr space(const std::string& surface, int cells) const;
  virtual ProblemPtr problem(SpacePtr space, problem::CahnHilliardModel model) const;
  // The model of discs that a study asks for.
  virtual discs::DiscModel disc_model(discs::DiscModel model) const { return model; }
  // The rule of a mesh that follows the boundaries.
  virtual fem::RefinementRule refinement_rule(fem::RefinementRule rule) const { return rule; }
  virtual time::IntegratorPtr make_integrator(const problem::DaeProblem& problem,
                                              const fem::SurfaceSpace& space,
                                              const std::string& name,
                                              const std::string& linear_solver,
                                              const time::IntegratorSettings& settings) const;
  // The bench's integrator and solver; tolerance 0: the integrator's own.
  time::IntegratorPtr default_integrator(const problem::CahnHilliard& problem,
                                         double tolerance = 0) const;

  // job(0) … job(count − 1), as many at a time as there are threads: each has to work on spaces of
  // one thread.
  void in_parallel(int count, const std::function<void(int)>& job, Part part = {}) const;
};

problem::CahnHilliardModel bench_model(const std::string& mobility, double epsilon);

// Throws std::runtime_error, as the functions below do where a computation fails.
void require(const Status& status);

// A consistent state with these nodal values of c.
struct StartState {
  Vec y, ydot;
};
StartState consistent_state(const problem::CahnHilliard& problem, VecView c);
// `initial` as in --initial; ε and the well are the problem's.
StartState initial_state(const problem::CahnHilliard& problem, const std::string& initial,
                         problem::InitialRequest request);

// Steps to t_end; on_step, which may be empty, sees every accepted one.
void advance_to(time::Integrator& integrator, const StartState& start, double t_end,
                const std::function<void()>& on_step = {});

}  // namespace traceraft::bench
