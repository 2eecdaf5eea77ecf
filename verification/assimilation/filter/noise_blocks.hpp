// Values near each other, by which the covariance of noise is estimated: blocks of a snapshot that
// are small enough for dense matrices.
#pragma once

#include <vector>

#include "kernel/core/types.hpp"

namespace traceraft::assimilation {

using BlockRows = std::vector<Eigen::Index>;

// Compact blocks of points, all about equal in number and none larger than `most`: halves of
// halves, across where they extend furthest.
std::vector<BlockRows> compact_blocks(const std::vector<Point>& points, std::size_t most);

struct NoiseBlock {
  Vec values;  // with mean 0
  // The known part of their covariance, values × values. The noise adds the other part.
  Eigen::MatrixXd known;
  Vec deviation;             // standard deviation of the noise of each value, up to a common level
  Eigen::MatrixXd distance;  // between the points, values × values
};

// The distances between the points of these rows, rows × rows.
Eigen::MatrixXd distances(const std::vector<Point>& points, const BlockRows& rows);

}  // namespace traceraft::assimilation
