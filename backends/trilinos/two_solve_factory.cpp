#include "backends/trilinos/two_solve_factory.hpp"

#include <Teko_BlockImplicitLinearOp.hpp>
#include <Teko_CloneFactory.hpp>
#include <Teko_InverseLibrary.hpp>
#include <Teko_Utilities.hpp>

#include "backends/trilinos/tpetra_space.hpp"

namespace traceraft::trilinos {
namespace {

using Teuchos::RCP;
using Teuchos::rcp;

// a A + b B, on their common graph.
RCP<const TpetraMatrix> combined(double a, const TpetraMatrix& A, double b, const TpetraMatrix& B) {
  const auto sum = rcp(new TpetraMatrix(A.getCrsGraph()));
  sum->fillComplete(A.getDomainMap(), A.getRangeMap());
  const auto values = sum->getLocalMatrixHost().values;
  const auto first = A.getLocalMatrixHost().values, second = B.getLocalMatrixHost().values;
  for (std::size_t k = 0; k < values.extent(0); ++k) values(k) = a * first(k) + b * second(k);
  return sum;
}

class TwoSolveInverse final : public Teko::BlockImplicitLinearOp {
 public:
  TwoSolveInverse(const Teko::BlockedLinearOp& A, Teko::LinearOp mass, Teko::LinearOp first,
                  Teko::LinearOp second, const TwoSolveRequest& shifts)
      : domain_(A->productRange()),
        range_(A->productDomain()),
        mass_(std::move(mass)),
        first_(std::move(first)),
        second_(std::move(second)),
        shifts_(shifts) {}

  Teko::VectorSpace range() const override { return range_; }
  Teko::VectorSpace domain() const override { return domain_; }

  void implicitApply(const Teko::BlockedMultiVector& r, Teko::BlockedMultiVector& z, double alpha,
                     double beta) const override {
    const Teko::MultiVector r1 = Teko::getBlock(0, r), r2 = Teko::getBlock(1, r);
    Teko::MultiVector right = Teko::deepcopy(r1), v = Teko::deepcopy(r1), c = Teko::deepcopy(r1);
    Teko::update(shifts_.p, r2, shifts_.row_scale, right);
    Teko::applyOp(first_, right, v, 1.0, 0.0);
    Teko::applyOp(mass_, v, right, 1.0, 0.0);
    Teko::update(-1.0, r2, 1.0, right);
    Teko::applyOp(second_, right, c, 1.0, 0.0);
    Teko::MultiVector zc = Teko::getBlock(0, z), zm = Teko::getBlock(1, z);
    Teko::update(alpha, c, beta, zc);
    Teko::update(shifts_.q, c, 1.0, v);
    Teko::update(alpha, v, beta, zm);
  }

 private:
  RCP<const Thyra::ProductVectorSpaceBase<double>> domain_, range_;
  Teko::LinearOp mass_, first_, second_;
  TwoSolveRequest shifts_;
};

// The inverse of that name in the state of the preconditioner, made or renewed.
Teko::LinearOp updated(const Teko::InverseFactory& factory, const ThyraOperator& matrix,
                       const char* name, Teko::BlockPreconditionerState& state) {
  Teko::ModifiableLinearOp& inverse = state.getModifiableOp(name);
  if (inverse.is_null())
    inverse = Teko::buildInverse(factory, matrix);
  else
    Teko::rebuildInverse(factory, matrix, inverse);
  return inverse;
}

}  // namespace

void TwoSolveFactory::register_by_name() {
  static const bool once = [] {
    Teko::PreconditionerFactory::addPreconditionerFactory(
        kName, rcp(new Teko::AutoClone<TwoSolveFactory>()));
    return true;
  }();
  (void)once;
}

void TwoSolveFactory::initializeFromParameterList(const Teuchos::ParameterList& parameters) {
  const auto inverse = [&](const char* name) {
    return getInverseLibrary()->getInverseFactory(parameters.get<std::string>(name));
  };
  first_ = inverse("First Inverse Type");
  second_ = inverse("Second Inverse Type");
}

Teko::LinearOp TwoSolveFactory::buildPreconditionerOperator(
    Teko::BlockedLinearOp& A, Teko::BlockPreconditionerState& state) const {
  const auto shifts = getRequestHandler()->request<TwoSolveRequest>(kName);
  const Teko::LinearOp mass = Teko::getBlock(1, 1, A);
  const TpetraMatrix& M = as_matrix(mass);
  const auto first = combined(shifts.row_scale, as_matrix(Teko::getBlock(0, 1, A)), shifts.p, M);
  const auto second = combined(-1, as_matrix(Teko::getBlock(1, 0, A)), -shifts.q, M);
  return rcp(new TwoSolveInverse(A, mass, updated(*first_, as_operator(first), "first", state),
                                 updated(*second_, as_operator(second), "second", state), shifts));
}

}  // namespace traceraft::trilinos
