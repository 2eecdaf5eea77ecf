// The points of Γ_h that are nearest to given ones.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

#include "kernel/mesh/cut_surface.hpp"

namespace traceraft::mesh {

// A point of Γ_h: on one of its triangles, in barycentric coordinates.
struct SurfacePlace {
  int triangle;
  std::array<double, 3> at;
};

// A tree of boxes around triangles of any size: those of a list, or all if it is empty. The surface
// must outlive it; finding is thread-safe.
class NearestTriangle {
 public:
  explicit NearestTriangle(const CutSurface& surface, std::vector<int> triangles = {});

  struct Found {
    SurfacePlace place{-1, {}};
    double distance = std::numeric_limits<double>::infinity();
  };
  // The nearest place; of equally near ones, that of the first triangle in the tree.
  Found find(const Point& x) const;

 private:
  // The triangles in a range of order_; the first half is the next box, the second half the box
  // `second`. 0: it is a leaf.
  struct Box {
    Eigen::AlignedBox3d box;
    int begin, end, second;
  };

  std::array<Point, 3> corners(int triangle) const;
  Eigen::AlignedBox3d box_of(int triangle) const;
  void split(int begin, int end);
  void look(const Box& leaf, const Point& x, Found& nearest) const;

  const CutSurface& surface_;
  std::vector<int> order_;
  std::vector<Box> boxes_;
};

}  // namespace traceraft::mesh
