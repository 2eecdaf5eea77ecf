#include "backends/trilinos/belos_method.hpp"

#include <BelosBiCGStabSolMgr.hpp>
#include <BelosBlockGmresSolMgr.hpp>
#include <BelosGCRODRSolMgr.hpp>
#include <BelosPseudoBlockGmresSolMgr.hpp>
#include <BelosThyraAdapter.hpp>
#include <Thyra_VectorStdOps.hpp>
#include <cmath>
#include <memory>

#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"

namespace traceraft::trilinos {
namespace {

using Teuchos::ParameterList;
using Teuchos::RCP;
using Teuchos::rcp;
using MultiVector = Thyra::MultiVectorBase<double>;
using Operator = Thyra::LinearOpBase<double>;
using Problem = Belos::LinearProblem<double, MultiVector, Operator>;
using Manager = Belos::SolverManager<double, MultiVector, Operator>;

constexpr int kMaxIterations = 200;
constexpr char kTolerance[] = "Convergence Tolerance";

// MueLu works on one vector, or on as many as the last time; gcrodr brings ten at first.
class ColumnByColumn final : public Thyra::LinearOpBase<double> {
 public:
  explicit ColumnByColumn(ThyraOperator inner) : inner_(std::move(inner)) {}
  RCP<const Thyra::VectorSpaceBase<double>> range() const override { return inner_->range(); }
  RCP<const Thyra::VectorSpaceBase<double>> domain() const override { return inner_->domain(); }

 protected:
  bool opSupportedImpl(Thyra::EOpTransp transpose) const override {
    return inner_->opSupported(transpose);
  }
  void applyImpl(Thyra::EOpTransp transpose, const MultiVector& x,
                 const Teuchos::Ptr<MultiVector>& y, double alpha, double beta) const override {
    for (Thyra::Ordinal j = 0; j < x.domain()->dim(); ++j) {
      const Teuchos::Range1D column(j, j);
      Thyra::apply(*inner_, transpose, *x.subView(column), y->subView(column).ptr(), alpha, beta);
    }
  }

 private:
  ThyraOperator inner_;
};

RCP<Manager> make_manager(const std::string& name) {
  if (name == "fgmres") return rcp(new Belos::BlockGmresSolMgr<double, MultiVector, Operator>);
  if (name == "gmres") return rcp(new Belos::PseudoBlockGmresSolMgr<double, MultiVector, Operator>);
  if (name == "gcrodr") return rcp(new Belos::GCRODRSolMgr<double, MultiVector, Operator>);
  return rcp(new Belos::BiCGStabSolMgr<double, MultiVector, Operator>);
}

class Method final : public BelosMethod {
 public:
  Method(std::string name, RCP<ParameterList> parameters)
      : name_(std::move(name)), manager_(make_manager(name_)), parameters_(std::move(parameters)) {}

  linear::SolveReport solve(const ThyraOperator& A, const ThyraOperator& preconditioner,
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
    parameters_->set(kTolerance, std::min(0.9, tolerance * norm / start));
    const auto problem = rcp(new Problem(A, x, b));
    problem->setRightPrec(rcp(new ColumnByColumn(preconditioner)));
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

  void forget() override { manager_ = make_manager(name_); }

 private:
  std::string name_;
  RCP<Manager> manager_;
  RCP<ParameterList> parameters_;
};

// Belos takes its list as it is and complains at the first solve.
void check_names(const std::string& method, const ParameterList& own) {
  const RCP<const ParameterList> known = make_manager(method)->getValidParameters();
  std::vector<std::string> names;
  for (auto entry = known->begin(); entry != known->end(); ++entry)
    names.push_back(known->name(entry));
  for (auto entry = own.begin(); entry != own.end(); ++entry) {
    const std::string& name = own.name(entry);
    if (name == kTolerance)
      throw InputError(
          "Belos: \"" + name +
          "\" is what the integrator asks for; choose the tolerance of linear solves there");
    if (!known->isParameter(name))
      throw InputError("Belos: " + unknown_name_message("parameter", name, names));
  }
}

}  // namespace

std::unique_ptr<BelosMethod> make_belos_method(const std::string& name, const ParameterList& own) {
  const auto parameters = rcp(new ParameterList);
  parameters->set("Maximum Iterations", kMaxIterations);
  parameters->set("Verbosity", 0);
  if (name == "fgmres") parameters->set("Flexible Gmres", true);
  if (name == "fgmres" || name == "gmres") parameters->set("Num Blocks", 50);
  if (name == "gcrodr") parameters->set("Num Blocks", 40).set("Num Recycled Blocks", 10);
  if (name != "bicgstab") parameters->set("Maximum Restarts", 20);
  check_names(name, own);
  parameters->setParameters(own);
  return std::make_unique<Method>(name, parameters);
}

}  // namespace traceraft::trilinos
