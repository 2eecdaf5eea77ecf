#include "backends/suitesparse/supernodal_structure.hpp"

#include <algorithm>
#include <new>
#include <stdexcept>

#include "backends/suitesparse/cholmod_workspace.hpp"
#include "backends/suitesparse/ordering.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::suitesparse {
namespace {

// CHOLMOD's matrix and factor, released with the workspace they belong to.
struct Analysis {
  CholmodWorkspace workspace;
  cholmod_sparse* matrix = nullptr;
  cholmod_factor* factor = nullptr;
  ~Analysis() {
    cholmod_free_factor(&factor, &workspace.common);
    cholmod_free_sparse(&matrix, &workspace.common);
  }
};

// By the minimum degree of CHOLMOD if no ordering is given.
void analyse_by_cholmod(std::vector<int>* ordering, Analysis& analysis) {
  cholmod_common* common = &analysis.workspace.common;
  common->method[0].ordering = ordering ? CHOLMOD_GIVEN : CHOLMOD_AMD;
  cholmod_free_factor(&analysis.factor, common);
  analysis.factor =
      cholmod_analyze_p(analysis.matrix, ordering ? ordering->data() : nullptr, nullptr, 0, common);
  if (analysis.factor) return;
  if (common->status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (common->status == CHOLMOD_TOO_LARGE)
    throw InputError(
        "linear solver block: its factors have more than 2^31 entries on this mesh; use a "
        "coarser mesh, or the linear solver teko");
  throw std::runtime_error("CHOLMOD: symbolic analysis failed");
}

void analyse_by_cholmod(const fem::SparsityPattern& pattern, Ordering ordering,
                        Analysis& analysis) {
  constexpr double kFewNumbers = 42;  // of L, for each row
  analysis.matrix = upper_triangle(pattern, &analysis.workspace.common);
  if (ordering == Ordering::quick) {
    analyse_by_cholmod(nullptr, analysis);
    if (analysis.workspace.common.lnz <= kFewNumbers * pattern.rows()) return;
  }
  std::vector<int> dissection = metis_ordering(pattern);
  analyse_by_cholmod(&dissection, analysis);
}

void read_supernodes(const cholmod_factor& factor, SupernodalStructure& structure) {
  const int* super = static_cast<const int*>(factor.super);
  const int* row_begin = static_cast<const int*>(factor.pi);
  const int* rows = static_cast<const int*>(factor.s);
  const int* order = static_cast<const int*>(factor.Perm);
  structure.permutation.assign(order, order + factor.n);
  structure.rows.assign(rows, rows + factor.ssize);
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    Supernode node{};
    node.first_column = super[s];
    node.columns = super[s + 1] - super[s];
    node.rows = row_begin[s + 1] - row_begin[s];
    node.row_begin = static_cast<std::size_t>(row_begin[s]);
    structure.supernodes.push_back(node);
    structure.most_rows = std::max(structure.most_rows, node.rows);
    structure.largest_trapezoid =
        std::max(structure.largest_trapezoid, static_cast<std::size_t>(node.rows) * node.columns);
  }
}

// Children of each supernode, in postorder; the roots are those of an additional last one.
std::vector<std::vector<int>> children_of(const SupernodalStructure& structure) {
  const int count = static_cast<int>(structure.supernodes.size());
  std::vector<int> supernode_of(structure.permutation.size());
  for (int s = 0; s < count; ++s)
    for (int k = 0; k < structure.supernodes[s].columns; ++k)
      supernode_of[structure.supernodes[s].first_column + k] = s;
  std::vector<std::vector<int>> children(count + 1);
  for (int s = 0; s < count; ++s) {
    const Supernode& node = structure.supernodes[s];
    const bool root = node.rows == node.columns;
    const int parent = root ? count : supernode_of[structure.rows[node.row_begin + node.columns]];
    children[parent].push_back(s);
  }
  return children;
}

int place_of(const SupernodalStructure& structure, const Supernode& node, int row) {
  const int* begin = structure.rows.data() + node.row_begin;
  return static_cast<int>(std::lower_bound(begin, begin + node.rows, row) - begin);
}

// Where the rows of children are among those of their parents, and the memory that all update
// matrices take which wait for their parents.
void plan_updates(const std::vector<std::vector<int>>& children, SupernodalStructure& structure) {
  structure.places.assign(structure.rows.size(), 0);
  std::size_t depth = 0;
  const auto update_size = [](const Supernode& node) {
    const auto size = static_cast<std::size_t>(node.rows - node.columns);
    return size * size;
  };
  for (std::size_t s = 0; s < structure.supernodes.size(); ++s) {
    Supernode& node = structure.supernodes[s];
    node.first_child = static_cast<int>(structure.child_list.size());
    node.children = static_cast<int>(children[s].size());
    depth += update_size(node);
    structure.deepest_stack = std::max(structure.deepest_stack, depth);
    for (const int c : children[s]) {
      const Supernode& child = structure.supernodes[c];
      structure.child_list.push_back(c);
      depth -= update_size(child);
      for (int k = child.columns; k < child.rows; ++k)
        structure.places[child.row_begin + k] =
            place_of(structure, node, structure.rows[child.row_begin + k]);
    }
  }
}

void place_entries(const fem::SparsityPattern& pattern, SupernodalStructure& structure) {
  std::vector<int> inverse(structure.permutation.size());
  for (std::size_t k = 0; k < inverse.size(); ++k)
    inverse[structure.permutation[k]] = static_cast<int>(k);
  structure.entries.reserve(static_cast<std::size_t>(pattern.entries() + pattern.rows()) / 2);
  for (Supernode& node : structure.supernodes) {
    node.entry_begin = structure.entries.size();
    for (int k = 0; k < node.columns; ++k) {
      const int column = node.first_column + k, row_of_a = structure.permutation[column];
      for (int e = pattern.row_begin[row_of_a]; e < pattern.row_begin[row_of_a + 1]; ++e) {
        const int row = inverse[pattern.column[e]];
        if (row < column) continue;
        structure.entries.push_back({e, k * node.rows + place_of(structure, node, row)});
      }
    }
    node.entry_end = structure.entries.size();
  }
}

std::size_t numbers_before(const SupernodalStructure& structure, int s) {
  std::size_t count = 0;
  for (int k = 0; k < s; ++k)
    count +=
        static_cast<std::size_t>(structure.supernodes[k].rows) * structure.supernodes[k].columns;
  return count;
}

// From the root downwards as long as a supernode has one child; the children of the first one with
// more become the branches, in two groups of about equal length in memory. In postorder a subtree
// is contiguous and ends with its root.
void find_branches(const std::vector<std::vector<int>>& children, SupernodalStructure& structure) {
  const int count = static_cast<int>(structure.supernodes.size());
  int top = count;
  while (children[top].size() == 1) top = children[top].front();
  const std::vector<int>& branches = children[top];
  int begin = branches.empty() ? 0 : branches.front();
  while (begin < count && !children[begin].empty()) begin = children[begin].front();
  const int end = branches.empty() ? 0 : branches.back() + 1;
  const std::size_t half = (numbers_before(structure, begin) + numbers_before(structure, end)) / 2;
  const auto distance = [&](int s) {
    const std::size_t at = numbers_before(structure, s);
    return at > half ? at - half : half - at;
  };
  int middle = end;
  for (const int child : branches)
    if (distance(child + 1) < distance(middle)) middle = child + 1;
  structure.branch_begin[0] = begin;
  structure.branch_begin[1] = middle;
  structure.branch_begin[2] = end;
  structure.top_row = end < count ? structure.supernodes[end].first_column
                                  : static_cast<int>(structure.permutation.size());
  for (Supernode& node : structure.supernodes)
    node.below_top = place_of(structure, node, structure.top_row);
}

}  // namespace

std::shared_ptr<const SupernodalStructure> analyse(const fem::SparsityPattern& pattern,
                                                   Ordering ordering) {
  Analysis analysis;
  analyse_by_cholmod(pattern, ordering, analysis);
  auto structure = std::make_shared<SupernodalStructure>();
  read_supernodes(*analysis.factor, *structure);
  const std::vector<std::vector<int>> children = children_of(*structure);
  plan_updates(children, *structure);
  place_entries(pattern, *structure);
  find_branches(children, *structure);
  return structure;
}

}  // namespace traceraft::suitesparse
