#include "kernel/fem/csr.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace traceraft::fem {

PatternPtr build_pattern(const mesh::ActiveMesh& mesh, std::shared_ptr<const Communicator> ranks) {
  auto pattern = std::make_shared<SparsityPattern>();
  pattern->halo = {mesh.owned_nodes, mesh.nodes(), mesh.halo, std::move(ranks)};
  const int rows = mesh.owned_nodes;
  pattern->row_begin.assign(rows + 1, 0);
  for (int i = 0; i < rows; ++i) ++pattern->row_begin[i + 1];  // the diagonal
  for (const auto& [low, high] : mesh.edges)
    for (const int i : {low, high})
      if (i < rows) ++pattern->row_begin[i + 1];
  std::partial_sum(pattern->row_begin.begin(), pattern->row_begin.end(),
                   pattern->row_begin.begin());
  struct Entry {
    int column, edge;
  };
  std::vector<Entry> entries(pattern->row_begin.back());
  std::vector<int> next(pattern->row_begin.begin(), pattern->row_begin.end() - 1);
  for (int i = 0; i < rows; ++i) entries[next[i]++] = {i, -1};
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto [low, high] = mesh.edges[e];
    if (low < rows) entries[next[low]++] = {high, static_cast<int>(e)};
    if (high < rows) entries[next[high]++] = {low, static_cast<int>(e)};
  }
  pattern->column.reserve(entries.size());
  pattern->edge_of_entry.reserve(entries.size());
  pattern->diagonal.reserve(rows);
  pattern->low_high.assign(mesh.edges.size(), -1);
  pattern->high_low.assign(mesh.edges.size(), -1);
  for (int i = 0; i < rows; ++i) {
    std::sort(entries.begin() + pattern->row_begin[i], entries.begin() + pattern->row_begin[i + 1],
              [&](const Entry& a, const Entry& b) {
                return mesh.node_id[a.column] < mesh.node_id[b.column];
              });
    for (int k = pattern->row_begin[i]; k < pattern->row_begin[i + 1]; ++k) {
      const auto [column, edge] = entries[k];
      if (edge < 0)
        pattern->diagonal.push_back(k);
      else
        (mesh.edges[edge].low == i ? pattern->low_high : pattern->high_low)[edge] = k;
      pattern->column.push_back(column);
      pattern->edge_of_entry.push_back(edge);
    }
  }
  return pattern;
}

void CsrMatrix::multiply_add(double factor, VecView x, VecRef y, const ThreadTeam& team) const {
  const SparsityPattern& p = *pattern;
  team.for_range(p.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double sum = 0;
      for (int k = p.row_begin[i]; k < p.row_begin[i + 1]; ++k) sum += values[k] * x[p.column[k]];
      y[i] += factor * sum;
    }
  });
}

void CsrMatrix::multiply(VecView x, VecRef y, const ThreadTeam& team) const {
  y.setZero();
  multiply_add(1.0, x, y, team);
}

double CsrMatrix::bilinear(VecView x, VecView y, const ThreadTeam& team) const {
  Vec product = Vec::Zero(pattern->rows());
  multiply_add(1.0, y, product, team);
  return dot(x.head(pattern->rows()), product);
}

CsrMatrix combine(double a, const CsrMatrix& A, double b, const CsrMatrix& B) {
  CsrMatrix result(A.pattern);
  for (std::size_t k = 0; k < result.values.size(); ++k)
    result.values[k] = a * A.values[k] + b * B.values[k];
  return result;
}

double dot(VecView x, VecView y) {
  // Four running sums: vectorisable without letting the compiler reorder anything.
  double sum[4] = {0, 0, 0, 0};
  const Eigen::Index quarter = x.size() / 4 * 4;
  for (Eigen::Index i = 0; i < quarter; i += 4)
    for (int k = 0; k < 4; ++k) sum[k] += x[i + k] * y[i + k];
  for (Eigen::Index i = quarter; i < x.size(); ++i) sum[0] += x[i] * y[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace traceraft::fem
