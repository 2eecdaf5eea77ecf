// Operators on a sphere that multiply every spherical harmonic by a number of its degree.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "kernel/core/communicator.hpp"
#include "kernel/core/thread_team.hpp"
#include "kernel/core/types.hpp"

namespace traceraft::flow {

// u = Σ_lm g_l Y_lm (Y_lmᵀ b) for values b at scattered points, with Y_lm as the vector of its
// values there: symmetric, and positive semidefinite for g_l ≥ 0, to roundoff. It costs a number of
// operations per point, not one per point and harmonic:
//   points → grid of rings → Fourier series of a ring → harmonics, and back by the transposed
//   steps.
// The grid has four points for the shortest wave, and local polynomials of degree 7 lead to the
// points. They reproduce a harmonic of the highest degree to 2e-2, one of half of it to 1e-4 and
// one of a quarter to 4e-7.
class HarmonicMultiplier {
 public:
  // `points`: only their directions count, and none is 0. `gain[l]`: g_l of l = 0 … degree.
  HarmonicMultiplier(
      const std::vector<Point>& points, Vec gain, std::shared_ptr<const ThreadTeam> team,
      std::shared_ptr<const Communicator> ranks = std::make_shared<SerialCommunicator>());

  int degree() const { return static_cast<int>(gain_.size()) - 1; }
  // Values at the points of this rank. The same to the last bit on any number of threads;
  // collective, with sums over the points of all ranks.
  Vec apply(VecView b) const;

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
  Grid spread(VecView b) const;           // the transpose of the interpolation, with the margin
  Grid folded(const Grid& padded) const;  // adds a margin to the places it stands for
  Grid with_margin(const Grid& grid) const;
  Grid multiplied(const Grid& grid) const;
  Grid summed_over_ranks(Grid grid) const;

  Vec gain_;
  std::shared_ptr<const ThreadTeam> team_;
  std::shared_ptr<const Communicator> ranks_;
  int rings_, columns_;
  std::vector<Stencil> stencils_;          // one per point
  Eigen::MatrixXd waves_;                  // columns × (1, cos φ, sin φ, cos 2φ, …)
  std::vector<Eigen::MatrixXd> legendre_;  // of each order m: rings × (degree − m + 1)
};

}  // namespace traceraft::flow
