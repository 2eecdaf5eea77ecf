#include "kernel/mesh/nearest_triangle.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace traceraft::mesh {
namespace {

using Barycentric = std::array<double, 3>;

// The place of the point of the segment a b that is nearest to x: 0 at a, 1 at b.
double along(const Point& a, const Point& b, const Point& x) {
  const Point edge = b - a;
  const double length2 = edge.squaredNorm();
  return length2 > 0 ? std::clamp((x - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
}

// The point of a triangle that is nearest to x: inside it, or on the nearest of its edges.
Barycentric nearest_in_triangle(const std::array<Point, 3>& corner, const Point& x) {
  const Point u = corner[1] - corner[0], v = corner[2] - corner[0], w = x - corner[0];
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v);
  const double determinant = uu * vv - uv * uv;
  if (determinant > 1e-14 * uu * vv) {
    const double b = (vv * u.dot(w) - uv * v.dot(w)) / determinant;
    const double c = (uu * v.dot(w) - uv * u.dot(w)) / determinant;
    if (b >= 0 && c >= 0 && b + c <= 1) return {1 - b - c, b, c};
  }
  Barycentric best{};
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const double s = along(corner[k], corner[next], x);
    const double distance = (corner[k] + s * (corner[next] - corner[k]) - x).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    best = {};
    best[k] = 1 - s;
    best[next] = s;
  }
  return best;
}

}  // namespace

NearestTriangle::NearestTriangle(const CutSurface& surface, std::vector<int> triangles)
    : surface_(surface), order_(std::move(triangles)) {
  if (order_.empty()) {
    order_.resize(surface.triangles.size());
    std::iota(order_.begin(), order_.end(), 0);
  }
  if (!order_.empty()) split(0, static_cast<int>(order_.size()));
}

std::array<Point, 3> NearestTriangle::corners(int triangle) const {
  const auto& [i, j, k] = surface_.triangles[triangle];
  return {surface_.position[i], surface_.position[j], surface_.position[k]};
}

Eigen::AlignedBox3d NearestTriangle::box_of(int triangle) const {
  Eigen::AlignedBox3d box;
  for (const Point& x : corners(triangle)) box.extend(x);
  return box;
}

// By the median of the centres along the longest side of the box.
void NearestTriangle::split(int begin, int end) {
  constexpr int kLeaf = 8;
  Box box{{}, begin, end, 0};
  for (int k = begin; k < end; ++k) box.box.extend(box_of(order_[k]));
  const std::size_t number = boxes_.size();
  boxes_.push_back(box);
  if (end - begin <= kLeaf) return;
  Eigen::Index axis;
  box.box.sizes().maxCoeff(&axis);
  const auto centre = [&](int triangle) {
    const auto& [i, j, k] = surface_.triangles[triangle];
    return surface_.position[i][axis] + surface_.position[j][axis] + surface_.position[k][axis];
  };
  const int middle = (begin + end) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](int a, int b) { return std::pair(centre(a), a) < std::pair(centre(b), b); });
  split(begin, middle);
  boxes_[number].second = static_cast<int>(boxes_.size());
  split(middle, end);
}

NearestTriangle::Found NearestTriangle::find(const Point& x) const {
  Found nearest;
  std::vector<std::pair<double, int>> todo;  // boxes and their distances; the last is the next
  if (!boxes_.empty()) todo.emplace_back(0, 0);
  while (!todo.empty()) {
    const auto [distance, number] = todo.back();
    todo.pop_back();
    if (distance > nearest.distance) continue;
    const Box& box = boxes_[number];
    if (box.second == 0) {
      look(box, x, nearest);
      continue;
    }
    std::pair<double, int> first(boxes_[number + 1].box.exteriorDistance(x), number + 1),
        second(boxes_[box.second].box.exteriorDistance(x), box.second);
    if (first < second) std::swap(first, second);
    todo.push_back(first);
    todo.push_back(second);
  }
  return nearest;
}

void NearestTriangle::look(const Box& leaf, const Point& x, Found& nearest) const {
  for (int k = leaf.begin; k < leaf.end; ++k) {
    const auto corner = corners(order_[k]);
    const Barycentric at = nearest_in_triangle(corner, x);
    const double distance = (at[0] * corner[0] + at[1] * corner[1] + at[2] * corner[2] - x).norm();
    if (distance < nearest.distance) nearest = {{order_[k], at}, distance};
  }
}

}  // namespace traceraft::mesh
