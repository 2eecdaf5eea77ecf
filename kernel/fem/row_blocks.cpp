#include "kernel/fem/row_blocks.hpp"

#include <algorithm>

namespace traceraft::fem {
namespace {

// From the first to the last item that touches.
template <class Item, class Touches>
IndexRange touching(const std::vector<Item>& items, const Touches& touches) {
  const auto first = std::find_if(items.begin(), items.end(), touches);
  const auto last = std::find_if(items.rbegin(), items.rend(), touches).base();
  const int begin = static_cast<int>(first - items.begin());
  return {begin, std::max(begin, static_cast<int>(last - items.begin()))};
}

}  // namespace

std::vector<RowBlock> split_rows(const mesh::ActiveMesh& mesh, const mesh::CutSurface& surface,
                                 const std::vector<CutElement>& elements, int parts) {
  std::vector<RowBlock> blocks;
  for (int part = 0; part < parts; ++part) {
    RowBlock block;
    const auto share = [&](std::size_t count) {
      const auto at = [&](int k) { return static_cast<int>(count * k / parts); };
      return IndexRange{at(part), at(part + 1)};
    };
    const IndexRange rows = block.rows = share(mesh.owned_nodes);
    const IndexRange points = block.points = share(surface.points.size());
    block.touching_elements = touching(elements, [&](const CutElement& element) {
      return std::any_of(element.node.begin(), element.node.end(),
                         [&](int node) { return rows.contains(node); });
    });
    block.touching_points = touching(surface.points, [&](const mesh::CutPoint& point) {
      return rows.contains(point.low) || rows.contains(point.high);
    });
    block.touching_triangles = touching(surface.triangles, [&](const std::array<int, 3>& triangle) {
      return std::any_of(triangle.begin(), triangle.end(),
                         [&](int point) { return points.contains(point); });
    });
    blocks.push_back(block);
  }
  return blocks;
}

}  // namespace traceraft::fem
