#include "kernel/fem/row_blocks.hpp"

#include <algorithm>

namespace traceraft {
namespace {

// Items are ascending in `low`: those with a low node in the rows.
template <class Item>
IndexRange owned(const std::vector<Item>& items, IndexRange rows) {
  const auto from = [&](int node) {
    return static_cast<int>(
        std::lower_bound(items.begin(), items.end(), node,
                         [](const Item& item, int low) { return item.low < low; }) -
        items.begin());
  };
  return {from(rows.begin), from(rows.end)};
}

// From the first to the last item that touches.
template <class Item, class Touches>
IndexRange touching(const std::vector<Item>& items, const Touches& touches) {
  const auto first = std::find_if(items.begin(), items.end(), touches);
  const auto last = std::find_if(items.rbegin(), items.rend(), touches).base();
  const int begin = static_cast<int>(first - items.begin());
  return {begin, std::max(begin, static_cast<int>(last - items.begin()))};
}

}  // namespace

std::vector<RowBlock> split_rows(const ActiveMesh& mesh, const CutSurface& surface,
                                 const std::vector<CutElement>& elements, int parts) {
  std::vector<RowBlock> blocks;
  for (int part = 0; part < parts; ++part) {
    RowBlock block;
    const auto row = [&](int k) {
      return static_cast<int>(std::int64_t{mesh.owned_nodes} * k / parts);
    };
    const IndexRange rows = block.rows = {row(part), row(part + 1)};
    block.edges = owned(mesh.edges, rows);
    block.points = owned(surface.points, rows);
    block.touching_elements = touching(elements, [&](const CutElement& element) {
      return std::any_of(element.node.begin(), element.node.end(),
                         [&](int node) { return rows.contains(node); });
    });
    block.touching_points = touching(surface.points, [&](const CutPoint& point) {
      return rows.contains(point.low) || rows.contains(point.high);
    });
    const auto triangle = [&](int element) {
      return element < static_cast<int>(elements.size())
                 ? elements[element].first_triangle
                 : static_cast<int>(surface.triangles.size());
    };
    block.touching_triangles = {triangle(block.touching_elements.begin),
                                triangle(block.touching_elements.end)};
    blocks.push_back(block);
  }
  return blocks;
}

}  // namespace traceraft
