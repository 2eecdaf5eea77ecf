// Objects of SUNDIALS that end with their owners.
#pragma once

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_nvector.h>

#include <memory>

namespace traceraft::sundials {

struct Destroy {
  void operator()(N_Vector v) const { N_VDestroy(v); }
  void operator()(SUNLinearSolver solver) const { SUNLinSolFreeEmpty(solver); }
  void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
};
using VectorPtr = std::unique_ptr<_generic_N_Vector, Destroy>;
using LinearPtr = std::unique_ptr<_generic_SUNLinearSolver, Destroy>;
using NewtonPtr = std::unique_ptr<_generic_SUNNonlinearSolver, Destroy>;

}  // namespace traceraft::sundials
