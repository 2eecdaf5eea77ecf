#include "backends/trilinos/belos_method.hpp"

#include <BelosBiCGStabSolMgr.hpp>
#include <BelosBlockGmresSolMgr.hpp>
#include <BelosGCRODRSolMgr.hpp>
#include <BelosPseudoBlockGmresSolMgr.hpp>
#include <BelosThyraAdapter.hpp>
#include <Thyra_VectorStdOps.hpp>
#include <cmath>
#include <memory>

namespace traceraft {
namespace {

using Teuchos::ParameterList;
using Teuchos::RCP;
using Teuchos::rcp;
using MultiVector = Thyra::MultiVectorBase<double>;
using Operator = Thyra::LinearOpBase<double>;
using Problem = Belos::LinearProblem<double, MultiVector, Operator>;
using Manager = Belos::SolverManager<double, MultiVector, Operator>;

constexpr int kMaxIterations = 200;

class Method final : public BelosMethod {
 public:
  Method(RCP<Manager> manager, RCP<ParameterList> parameters)
      : manager_(std::move(manager)), parameters_(std::move(parameters)) {}

  SolveReport solve(const ThyraOperator& A, const ThyraOperator& preconditioner,
                    const ThyraVector& b, const ThyraVector& x, double tolerance) override {
    const double norm = Thyra::norm_2(*b);
    if (norm == 0) {
      Thyra::assign(x.ptr(), 0.0);
      return {};
    }
    if (!std::isfinite(norm)) return {Status::retry("Belos: the right-hand side is not finite")};
    // Methods judge the fall of the residual from where they start.
    const auto residual = b->clone_v();
    Thyra::apply(*A, Thyra::NOTRANS, *x, residual.ptr(), -1.0, 1.0);
    const double start = Thyra::norm_2(*residual);
    if (start <= tolerance * norm) return {};
    parameters_->set("Convergence Tolerance", std::min(0.9, tolerance * norm / start));
    const auto problem = rcp(new Problem(A, x, b));
    problem->setRightPrec(preconditioner);
    problem->setProblem();
    manager_->setProblem(problem);
    manager_->setParameters(parameters_);
    const Belos::ReturnType end = manager_->solve();
    const int iterations = manager_->getNumIters();
    if (end != Belos::Converged)
      return {
          Status::retry("Belos: no convergence in " + std::to_string(iterations) + " iterations"),
          iterations};
    return {{}, iterations};
  }

 private:
  RCP<Manager> manager_;
  RCP<ParameterList> parameters_;
};

}  // namespace

std::unique_ptr<BelosMethod> make_belos_method(const std::string& name, const ParameterList& own) {
  const auto parameters = rcp(new ParameterList);
  parameters->set("Maximum Iterations", kMaxIterations);
  parameters->set("Verbosity", 0);
  RCP<Manager> manager;
  if (name == "fgmres") {
    parameters->set("Flexible Gmres", true);
    parameters->set("Num Blocks", 50);
    parameters->set("Maximum Restarts", 20);
    manager = rcp(new Belos::BlockGmresSolMgr<double, MultiVector, Operator>);
  } else if (name == "gmres") {
    parameters->set("Num Blocks", 50);
    parameters->set("Maximum Restarts", 20);
    manager = rcp(new Belos::PseudoBlockGmresSolMgr<double, MultiVector, Operator>);
  } else if (name == "gcrodr") {
    parameters->set("Num Blocks", 40);
    parameters->set("Num Recycled Blocks", 10);
    parameters->set("Maximum Restarts", 20);
    manager = rcp(new Belos::GCRODRSolMgr<double, MultiVector, Operator>);
  } else {
    manager = rcp(new Belos::BiCGStabSolMgr<double, MultiVector, Operator>);
  }
  parameters->setParameters(own);
  return std::make_unique<Method>(manager, parameters);
}

}  // namespace traceraft
