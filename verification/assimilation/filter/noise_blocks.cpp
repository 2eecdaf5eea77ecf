#include "verification/assimilation/filter/noise_blocks.hpp"

#include <algorithm>
#include <numeric>

namespace traceraft::assimilation {
namespace {

int widest_axis(const std::vector<Point>& points, const BlockRows& rows) {
  Point low = points[rows.front()], high = low;
  for (const Eigen::Index row : rows) {
    low = low.cwiseMin(points[row]);
    high = high.cwiseMax(points[row]);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  return axis;
}

void split(const std::vector<Point>& points, std::size_t most, BlockRows rows,
           std::vector<BlockRows>& blocks) {
  if (rows.size() <= most) {
    if (!rows.empty()) blocks.push_back(std::move(rows));
    return;
  }
  const int axis = widest_axis(points, rows);
  const auto middle = rows.begin() + static_cast<std::ptrdiff_t>(rows.size() / 2);
  std::nth_element(rows.begin(), middle, rows.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::pair(points[a][axis], a) < std::pair(points[b][axis], b);
  });
  split(points, most, BlockRows(rows.begin(), middle), blocks);
  split(points, most, BlockRows(middle, rows.end()), blocks);
}

}  // namespace

std::vector<BlockRows> compact_blocks(const std::vector<Point>& points, std::size_t most) {
  BlockRows all(points.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<BlockRows> blocks;
  split(points, most, std::move(all), blocks);
  return blocks;
}

Eigen::MatrixXd distances(const std::vector<Point>& points, const BlockRows& rows) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < j; ++i)
      result(i, j) = result(j, i) = (points[rows[i]] - points[rows[j]]).norm();
  return result;
}

}  // namespace traceraft::assimilation
