// A model and a linear solver that do what others do: to be derived from where a test interferes.
#pragma once

#include "kernel/core/checkpoint_stream.hpp"
#include "kernel/linear/linear_solver.hpp"
#include "kernel/problem/dae_problem.hpp"

namespace traceraft::testing {

class ForwardingProblem : public problem::DaeProblem {
 public:
  explicit ForwardingProblem(const problem::DaeProblem& inner) : inner_(inner) {}
  int block_size() const override { return inner_.block_size(); }
  Status residual(double t, VecView y, VecView ydot, VecRef r) const override {
    return inner_.residual(t, y, ydot, r);
  }
  Status jacobian(double t, VecView y, VecView ydot, double shift, linear::Tangent tangent,
                  linear::BlockJacobian& J) const override {
    return inner_.jacobian(t, y, ydot, shift, tangent, J);
  }
  Status jacobian_product(double t, VecView y, VecView ydot, double shift, linear::Tangent tangent,
                          VecView v, VecRef product) const override {
    return inner_.jacobian_product(t, y, ydot, shift, tangent, v, product);
  }
  linear::BlockJacobian make_jacobian() const override { return inner_.make_jacobian(); }
  Status consistent_initial_state(double t, VecRef y, VecRef ydot) const override {
    return inner_.consistent_initial_state(t, y, ydot);
  }
  double norm(VecView y) const override { return inner_.norm(y); }
  double field_norm(VecView half) const override { return inner_.field_norm(half); }
  double mass(VecView y) const override { return inner_.mass(y); }
  bool conserves_mass() const override { return inner_.conserves_mass(); }
  double energy(VecView y) const override { return inner_.energy(y); }
  bool dissipates_energy() const override { return inner_.dissipates_energy(); }
  bool dissipates_in_stabilised_steps() const override {
    return inner_.dissipates_in_stabilised_steps();
  }
  bool may_be_extrapolated() const override { return inner_.may_be_extrapolated(); }
  double longest_step() const override { return inner_.longest_step(); }
  double energy_scale() const override { return inner_.energy_scale(); }
  const Communicator& ranks() const override { return inner_.ranks(); }

 private:
  const problem::DaeProblem& inner_;
};

class ForwardingSolver : public linear::LinearSolver {
 public:
  explicit ForwardingSolver(linear::LinearSolverPtr inner) : inner_(std::move(inner)) {}
  std::string name() const override { return "faulty"; }
  bool shares_factors() const override { return inner_->shares_factors(); }
  Status setup(const linear::BlockJacobian& J, int lane) override { return inner_->setup(J, lane); }
  bool wants_setup(const linear::BlockJacobian& J, int lane) const override {
    return inner_->wants_setup(J, lane);
  }
  linear::SolveReport solve(const linear::BlockJacobian& J, VecView b, VecRef x, double tolerance,
                            int lane) override {
    return inner_->solve(J, b, x, tolerance, lane);
  }
  linear::LinearStatistics statistics() const override { return inner_->statistics(); }
  void save(CheckpointOut out) const override { inner_->save(out); }
  void load(CheckpointIn in) override { inner_->load(in); }

 private:
  linear::LinearSolverPtr inner_;
};

}  // namespace traceraft::testing
