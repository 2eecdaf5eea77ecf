// The symbolic half of a sparse Cholesky factorisation P A Pᵀ = L Lᵀ: which columns of L are
// computed together, and where each number goes. One serves all matrices of a sparsity pattern.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "kernel/fem/csr.hpp"

namespace traceraft::suitesparse {

// Neighbouring columns of L with the same rows, in which they are a dense trapezoid.
struct Supernode {
  int first_column, columns;
  int rows;               // the first `columns` rows are the triangular part
  int below_top;          // the first `below_top` rows belong to the branch of the supernode
  std::size_t row_begin;  // in SupernodalStructure::rows and ::places
  std::size_t entry_begin, entry_end;  // in SupernodalStructure::entries
  int first_child, children;           // in SupernodalStructure::child_list
};

struct SupernodalStructure {
  // An entry of the matrix, by its position among the values of its CSR form, and its place in the
  // dense columns of its supernode.
  struct Entry {
    int source, place;
  };

  std::vector<int> permutation;       // row of A for each row of P A Pᵀ
  std::vector<Supernode> supernodes;  // in postorder of the elimination tree
  std::vector<int> rows;              // of P A Pᵀ, for each supernode
  std::vector<int> places;  // of the rows below the triangle: among the rows of the parent
  std::vector<int> child_list;
  std::vector<Entry> entries;

  // The tree is cut into two branches, supernodes branch_begin[k] to branch_begin[k + 1], and the
  // top, from branch_begin[2] on, to which both contribute. Rows from top_row on are the top's.
  int branch_begin[3] = {0, 0, 0};
  int top_row = 0;

  int most_rows = 0;                  // of a supernode
  std::size_t largest_trapezoid = 0;  // rows x columns
  std::size_t deepest_stack = 0;      // numbers of update matrices that exist at the same time
};

// How rows are ordered so that L fills little.
enum class Ordering {
  dissection,  // by METIS
  // By minimum degree if L has few numbers then, else by METIS. It takes a tenth of the time of
  // METIS. On a mesh that is fine only along boundaries L has a tenth more numbers.
  quick
};

// Analyses by CHOLMOD. Throws InputError if L would have more than 2³¹ numbers.
std::shared_ptr<const SupernodalStructure> analyse(const fem::SparsityPattern& pattern,
                                                   Ordering ordering = Ordering::dissection);

}  // namespace traceraft::suitesparse
