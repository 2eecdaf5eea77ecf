// Sparse matrices of the P1 space on one shared pattern: a row per owned node, a column per local
// node, the columns of a row ascending in their global id.
#pragma once

#include <memory>
#include <vector>

#include "kernel/core/halo.hpp"
#include "kernel/core/thread_team.hpp"
#include "kernel/core/types.hpp"
#include "kernel/mesh/active_mesh.hpp"

namespace traceraft::fem {

struct SparsityPattern {
  std::vector<int> row_begin;      // rows + 1
  std::vector<int> column;         // local nodes, in the order of their global ids within a row
  std::vector<int> diagonal;       // position of (i, i)
  std::vector<int> edge_of_entry;  // active edge behind an entry, −1 on the diagonal
  std::vector<int> low_high;       // per edge: position of (low, high)
  std::vector<int> high_low;       // per edge: position of (high, low)
  Halo halo;                       // of the columns

  int rows() const { return static_cast<int>(row_begin.size()) - 1; }
  int entries() const { return static_cast<int>(column.size()); }
};

using PatternPtr = std::shared_ptr<const SparsityPattern>;

PatternPtr build_pattern(const mesh::ActiveMesh& mesh, std::shared_ptr<const Communicator> ranks);

struct CsrMatrix {
  PatternPtr pattern;
  std::vector<double> values;

  explicit CsrMatrix(PatternPtr p) : pattern(std::move(p)), values(pattern->entries(), 0.0) {}

  // y += factor · A x; x has ghosts
  void multiply_add(double factor, VecView x, VecRef y, const ThreadTeam& team) const;
  // y = A x
  void multiply(VecView x, VecRef y, const ThreadTeam& team) const;
  // xᵀ A y on the owned rows
  double bilinear(VecView x, VecView y, const ThreadTeam& team) const;
};

// a·A + b·B on the common pattern
CsrMatrix combine(double a, const CsrMatrix& A, double b, const CsrMatrix& B);

// xᵀy in one fixed order, so that a resumed run repeats it bitwise.
double dot(VecView x, VecView y);

}  // namespace traceraft::fem
