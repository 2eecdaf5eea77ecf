// The kernel's two-solve preconditioner as a block preconditioner factory of Teko.
#pragma once

#include <Teko_BlockPreconditionerFactory.hpp>
#include <Teko_InverseFactory.hpp>
#include <Teko_RequestCallback.hpp>

namespace traceraft::trilinos {

// The numbers that the factory cannot see in the operator: the shifts of the two solves
// (kernel/linear/two_solve_preconditioner.hpp), and by what the first block row has been divided.
struct TwoSolveRequest {
  double p = 0, q = 0, row_scale = 1;
};

// For an operator [cc cm; mc mm] whose first row is divided by row_scale, P⁻¹ (r₁, r₂):
//   (row_scale · cm + p mm) v = row_scale · r₁ + p r₂,  (−mc − q mm) δc = mm v − r₂,  δμ = v + q
//   δc.
// Parameters: "First Inverse Type" and "Second Inverse Type", names in the inverse library, for
// approximate inverses of the two matrices. Asks its request handler for "Two-Solve", a
// TwoSolveRequest. Rebuilt inverses keep what they can.
class TwoSolveFactory : public Teko::BlockPreconditionerFactory {
 public:
  static constexpr const char* kName = "Two-Solve";
  // Makes the factory known to inverse libraries by its name; may be called again.
  static void register_by_name();

  using Teko::BlockPreconditionerFactory::buildPreconditionerOperator;
  Teko::LinearOp buildPreconditionerOperator(Teko::BlockedLinearOp& A,
                                             Teko::BlockPreconditionerState& state) const override;
  void initializeFromParameterList(const Teuchos::ParameterList& parameters) override;

 private:
  Teuchos::RCP<Teko::InverseFactory> first_, second_;
};

// Answers the request with what it points to.
class TwoSolveCallback final : public Teko::RequestCallback<TwoSolveRequest> {
 public:
  explicit TwoSolveCallback(const TwoSolveRequest& answer) : answer_(answer) {}
  TwoSolveRequest request(const Teko::RequestMesg&) override { return answer_; }
  bool handlesRequest(const Teko::RequestMesg& message) override {
    return message.getName() == TwoSolveFactory::kName;
  }
  void preRequest(const Teko::RequestMesg&) override {}

 private:
  const TwoSolveRequest& answer_;
};

}  // namespace traceraft::trilinos
