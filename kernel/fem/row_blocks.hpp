// Who computes which rows. Each row is summed by one thread in global order, from every piece that
// touches it: results do not depend on the number of threads (or ranks).
#pragma once

#include <vector>

#include "kernel/fem/cut_elements.hpp"

namespace traceraft::fem {

struct IndexRange {
  int begin = 0, end = 0;
  bool contains(int i) const { return i >= begin && i < end; }
};

// The share of one thread. Ranges called `touching` contain all that contributes and some that does
// not; they overlap between neighbours.
struct RowBlock {
  IndexRange rows;
  IndexRange touching_elements;   // elements and
  IndexRange touching_points;     // points on the edges of the rows
  IndexRange points;              // an even share of them: they have no order of rows,
  IndexRange touching_triangles;  // and triangles at these
};

std::vector<RowBlock> split_rows(const mesh::ActiveMesh& mesh, const mesh::CutSurface& surface,
                                 const std::vector<CutElement>& elements, int parts);

}  // namespace traceraft::fem
