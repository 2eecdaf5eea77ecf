// Krylov methods of Belos on Thyra operators.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>
#include <vector>

#include "backends/trilinos/tpetra_space.hpp"
#include "kernel/linear/linear_solver.hpp"

namespace traceraft::trilinos {

// fgmres: GMRES with a flexible right preconditioner; gcrodr keeps a part of its space from one
// system to the next, until forget().
inline const std::vector<std::string> kBelosMethods = {"fgmres", "gmres", "gcrodr", "bicgstab"};

class BelosMethod {
 public:
  virtual ~BelosMethod() = default;
  // A x = b from the guess in x, preconditioned from the right, until the residual has fallen to
  // `tolerance` times that of x = 0. retry: it did not; the iterations count all the same.
  virtual linear::SolveReport solve(const ThyraOperator& A, const ThyraOperator& preconditioner,
                                    const ThyraVector& b, const ThyraVector& x,
                                    double tolerance) = 0;
  // From here on as if nothing had been solved before.
  virtual void forget() = 0;
};

// `own` changes parameters of the method, by Belos' names. Throws InputError for a name that the
// method does not know.
std::unique_ptr<BelosMethod> make_belos_method(const std::string& name,
                                               const Teuchos::ParameterList& own);

}  // namespace traceraft::trilinos
