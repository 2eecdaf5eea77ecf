#include "backends/suitesparse/ordering.hpp"

#include <mutex>
#include <new>
#include <stdexcept>

#include "backends/suitesparse/cholmod_workspace.hpp"

namespace traceraft::suitesparse {

cholmod_sparse* upper_triangle(const fem::SparsityPattern& pattern, cholmod_common* common) {
  const int n = pattern.rows();
  const std::size_t entries = static_cast<std::size_t>(pattern.entries() + n) / 2;
  cholmod_sparse* A = cholmod_allocate_sparse(n, n, entries, 1, 1, 1, CHOLMOD_PATTERN, common);
  if (!A) throw std::bad_alloc();
  int* begin = static_cast<int*>(A->p);
  int* row = static_cast<int*>(A->i);
  int at = 0;
  for (int column = 0; column < n; ++column) {
    begin[column] = at;
    for (int k = pattern.row_begin[column]; k <= pattern.diagonal[column]; ++k)
      row[at++] = pattern.column[k];
  }
  begin[n] = at;
  return A;
}

std::vector<int> metis_ordering(const fem::SparsityPattern& pattern) {
  // METIS seeds and draws from the C library's random numbers, which all threads share.
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  CholmodWorkspace workspace;
  cholmod_sparse* A = upper_triangle(pattern, &workspace.common);
  std::vector<int> ordering(pattern.rows());
  const int ok = cholmod_metis(A, nullptr, 0, 1, ordering.data(), &workspace.common);
  cholmod_free_sparse(&A, &workspace.common);
  if (!ok) throw std::runtime_error("METIS could not order the matrix");
  return ordering;
}

}  // namespace traceraft::suitesparse
