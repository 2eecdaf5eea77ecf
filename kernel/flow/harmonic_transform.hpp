// Real spherical harmonics at scattered points: a fast transform and its transpose.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "kernel/core/communicator.hpp"
#include "kernel/core/thread_team.hpp"
#include "kernel/core/types.hpp"

namespace traceraft::flow {

// Harmonics are real and orthonormal in L² of the unit sphere:
//   Y_lm(θ, φ) = P̃_l|m|(cos θ) {1/√2π, cos mφ/√π, sin |m|φ/√π} for m = 0, m > 0, m < 0,
//   ∫_{-1}^{1} P̃_lm² = 1.
// Coefficients stand in the order of l² + l + m, so that a higher degree only adds to them.
inline Eigen::Index harmonic_index(int l, int m) {
  return static_cast<Eigen::Index>(l) * l + l + m;
}

// Waves at equal angles φ (rows): 1/√2π, cos mφ/√π and sin |m|φ/√π for m up to a degree.
Eigen::MatrixXd waves_at(int angles, int degree);
// The column of the wave of order m.
inline Eigen::Index wave_index(int m) {
  return m > 0 ? 2 * m - 1 : -2 * m;
}

// f(l) for every harmonic up to a degree.
template <class OfDegree>
Vec by_degree(int degree, const OfDegree& f) {
  Vec values(harmonic_index(degree, degree) + 1);
  for (int l = 0; l <= degree; ++l)
    values.segment(harmonic_index(l, -l), 2 * l + 1).setConstant(f(l));
  return values;
}

// Synthesis is Y a and analysis is Yᵀ b, with Y as the matrix of the harmonics (columns) at points
// (rows). The one is the transpose of the other to roundoff. Either costs a number of operations
// per point, not one per point and harmonic:
//   points → grid of rings → Fourier series of a ring → harmonics, and back by the transposed
//   steps.
// The grid has four points for the shortest wave, and local polynomials of degree 7 lead to the
// points. Analysis and synthesis together reproduce a harmonic of the highest degree to 2e-2, one
// of half of it to 1e-4 and one of a quarter to 4e-7.
class HarmonicTransform {
 public:
  // `points`: only their directions count, and none is 0.
  HarmonicTransform(
      const std::vector<Point>& points, int degree, std::shared_ptr<const ThreadTeam> team,
      std::shared_ptr<const Communicator> ranks = std::make_shared<SerialCommunicator>());

  int degree() const { return degree_; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(degree_ + 1) * (degree_ + 1); }
  // Both are the same to the last bit on any number of threads. Values are at the points of this
  // rank. The analysis is collective and sums over the points of all ranks; it has size() entries.
  Vec analysis(VecView values) const;
  Vec synthesis(const Vec& coefficients) const;

 private:
  static constexpr int kPoints = 8;  // of a local polynomial, along each direction
  static constexpr int kBefore = kPoints / 2 - 1, kMargin = kPoints / 2;

  // Where a point lies: the first of 8 × 8 places of the grid with its margin, and their weights.
  struct Stencil {
    int ring, column;
    std::array<double, kPoints> across, along;
  };
  struct Place {
    int ring, column;
  };
  // Values on rings (rows) at equal angles (columns).
  using Grid = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Stencil stencil_of(const Point& point) const;
  Place place_of(int row, int column) const;
  Grid spread(VecView values) const;      // the transpose of the interpolation, with the margin
  Grid folded(const Grid& padded) const;  // adds a margin to the places it stands for
  Grid with_margin(const Grid& grid) const;
  Grid summed_over_ranks(Grid grid) const;

  int degree_;
  std::shared_ptr<const ThreadTeam> team_;
  std::shared_ptr<const Communicator> ranks_;
  int rings_, columns_;
  std::vector<Stencil> stencils_;          // one per point
  Eigen::MatrixXd waves_;                  // at the columns
  std::vector<Eigen::MatrixXd> legendre_;  // of each order m: rings × (degree − m + 1)
};

}  // namespace traceraft::flow
