// Linear perturbations of a solution: what becomes of a small change of the state, and of a small
// change of the model.
#pragma once

#include <Eigen/Core>

#include "kernel/linear/linear_solver.hpp"
#include "verification/assimilation/forecast/forecast.hpp"

namespace traceraft::assimilation {

inline constexpr double kTangentGamma = 0.2928932188134524756;  // 1 − 1/√2

// Columns are nodal perturbations δc.
using Columns = Eigen::MatrixXd;

// The change of F per unit of a parameter at (t, y): 2n × forced columns.
using Forcing = std::function<Columns(double t, VecView y)>;

// Along a solution, the DAE F(t, y, ẏ; θ) = 0 changes by M̃ δċ + ∂F/∂y δy + ∂F/∂θ = 0: advances the
// columns of S over the path's grid. The last ones, as many as `forcing` returns, are forced;
// without forcing none is. All columns share the factors of a stage. Throws std::runtime_error if a
// system cannot be solved.
class TangentFlow {
 public:
  // Columns are shared out over the team. The problem must outlive this object.
  TangentFlow(const problem::CahnHilliard& problem, const linear::LinearSolverFactory& make_solver,
              std::shared_ptr<const ThreadTeam> team);
  void advance(const TangentPath& along, Columns& S, const Forcing& forcing = {});

 private:
  // Solves M̃ (X − G) shift + ∂F/∂y X + forcing = 0 for the differential part.
  Columns solve_stage(double t, VecView y, double shift, const Columns& G, const Forcing& forcing);
  // By the factors of the assembled Jacobian: (c, μ), a column for each.
  Columns solve(const Columns& right);
  // Iterative refinement: what effects that couple distant points leave out of these.
  void refine(double t, VecView y, double shift, const Columns& right, Columns& X);

  const problem::CahnHilliard& problem_;
  std::shared_ptr<const ThreadTeam> team_;
  linear::LinearSolverPtr solver_;
  linear::BlockJacobian jacobian_;
  bool is_assembled_;
};

}  // namespace traceraft::assimilation
