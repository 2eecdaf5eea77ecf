// LU factors of the assembled Jacobian by different libraries.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "backends/suitesparse/assembled_system.hpp"
#include "kernel/core/status.hpp"

namespace traceraft::suitesparse {

class SparseLu {
 public:
  virtual ~SparseLu() = default;
  // `order`: of the rows and columns, against fill. The pattern is the same at every call.
  virtual Status factorise(AssembledSystem& system, const std::vector<int>& order) = 0;
  // After a successful factorise of the same system. retry if the library reports an error.
  virtual Status solve(AssembledSystem& system, const Vec& right, Vec& solution) = 0;
};

using SparseLuFactory = std::function<std::unique_ptr<SparseLu>()>;

std::unique_ptr<SparseLu> make_umfpack_lu();
std::unique_ptr<SparseLu> make_klu_lu();

}  // namespace traceraft::suitesparse
