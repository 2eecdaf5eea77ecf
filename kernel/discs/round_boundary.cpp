#include "kernel/discs/round_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "kernel/core/types.hpp"

namespace traceraft::discs {
namespace {

// In lengths of δ.
constexpr double kGrid = 0.025, kFarthest = 15, kLargest = 20, kSpacing = 0.25;
constexpr int kPerEntry = static_cast<int>(kSpacing / kGrid + 0.5);
constexpr int kEntries = static_cast<int>(kLargest / kSpacing + 0.5) + 1;

double force(double c) {
  return c * (1 - c) * (1 - 2 * c);
}
double well(double c) {  // f0/(2ρ)
  return 0.5 * c * c * (1 - c) * (1 - c);
}

// The stable phase outside of potential ν, by Newton's method.
double phase_outside(double nu) {
  double c = nu;
  for (int k = 0; k < 50; ++k) c -= (force(c) - nu) / (1 - 6 * c + 6 * c * c);
  return c;
}

// A raft that is in local equilibrium, on the points k kGrid.
class RoundRaft {
 public:
  RoundRaft() : c_(static_cast<Eigen::Index>((kLargest + kFarthest) / kGrid + 0.5) + 1) {
    for (Eigen::Index k = 0; k < c_.size(); ++k)
      c_[k] = 1 / (1 + std::exp(static_cast<double>(k) * kGrid - kLargest));
  }

  // Finds the raft with c = ½ at a point of the grid, from the one before.
  void solve(Eigen::Index half) {
    for (int iteration = 0; iteration < 40; ++iteration)
      if (newton_step(half) < 1e-12) return;
    throw std::logic_error("the profile of a round raft was not found");
  }

  RoundBoundary properties(double radius) const {
    const double outside = phase_outside(nu_), inside = 1 - phase_outside(-nu_);
    double mass = 0, energy = 0, gradients = 0;
    for (Eigen::Index k = 0; k + 1 < c_.size(); ++k) {
      const double r = static_cast<double>(k) * kGrid, ring = 2 * kPi * r * kGrid,
                   slope = (c_[k + 1] - c_[k]) / kGrid;
      mass += ring * (c_[k] - outside);
      energy += ring * (well(c_[k]) - well(outside));
      gradients += 2 * kPi * (r + kGrid / 2) * kGrid * slope * slope;
    }
    const double area = kPi * radius * radius, straight = 2 * kPi * radius / 6;
    return {6 * radius * nu_, mass - area * (inside - outside),
            (energy + gradients / 2 - area * (well(inside) - well(outside))) / straight,
            gradients / straight};
  }

 private:
  // Solves the tridiagonal system for both the residual and the change of ν; the latter follows
  // from c = ½. Returns the largest change.
  double newton_step(Eigen::Index half) {
    const Eigen::Index last = c_.size() - 1;
    Vec diagonal(last + 1), above(last + 1), change(last + 1), by_nu(last + 1);
    for (Eigen::Index k = 0; k <= last; ++k) {
      const double c = c_[k], curvature = k == 0 ? 0 : 0.5 / static_cast<double>(k);
      double below = (1 - curvature) / (kGrid * kGrid);
      above[k] = (1 + curvature) / (kGrid * kGrid);
      if (k == 0) {
        below = 0;
        above[k] = 4 / (kGrid * kGrid);
      }
      if (k == last) {
        below += above[k];  // no slope at the end
        above[k] = 0;
      }
      diagonal[k] = -(below + above[k]) - (1 - 6 * c + 6 * c * c);
      change[k] = force(c) - nu_ - (k == 0 ? 0 : below * (c_[k - 1] - c)) -
                  (k == last ? 0 : above[k] * (c_[k + 1] - c));
      by_nu[k] = -1;
      if (k == 0) continue;
      const double share = below / diagonal[k - 1];
      diagonal[k] -= share * above[k - 1];
      change[k] -= share * change[k - 1];
      by_nu[k] -= share * by_nu[k - 1];
    }
    for (Eigen::Index k = last; k >= 0; --k) {
      change[k] = (change[k] - (k == last ? 0 : above[k] * change[k + 1])) / diagonal[k];
      by_nu[k] = (by_nu[k] - (k == last ? 0 : above[k] * by_nu[k + 1])) / diagonal[k];
    }
    const double of_nu = (0.5 - c_[half] - change[half]) / by_nu[half];
    change += of_nu * by_nu;
    c_ += change;
    nu_ += of_nu;
    return change.cwiseAbs().maxCoeff() + std::fabs(of_nu);
  }

  Vec c_;
  double nu_ = 1 / (6 * kLargest);
};

using Table = std::vector<RoundBoundary>;

// At the radii 0, kSpacing, …, kLargest; at 0 where ratios have limits of their own, as next to it.
Table tabulated() {
  Table table(kEntries);
  RoundRaft raft;
  for (int k = kEntries - 1; k > 0; --k) {
    raft.solve(k * kPerEntry);
    table[static_cast<std::size_t>(k)] = raft.properties(k * kSpacing);
  }
  table[0] = table[1];
  return table;
}

constexpr double RoundBoundary::*kMembers[] = {&RoundBoundary::potential, &RoundBoundary::held_mass,
                                               &RoundBoundary::energy, &RoundBoundary::gradients};

}  // namespace

RoundBoundaryAt round_boundary(double radius) {
  static const Table table = tabulated();
  RoundBoundaryAt result{};
  if (radius >= kLargest) {
    const RoundBoundary& last = table.back();
    const double share = kLargest * kLargest / (radius * radius);
    result.value.held_mass = last.held_mass;
    for (auto member :
         {&RoundBoundary::potential, &RoundBoundary::energy, &RoundBoundary::gradients}) {
      result.value.*member = 1 + (last.*member - 1) * share;
      result.slope.*member = -2 * (last.*member - 1) * share / radius;
    }
    return result;
  }
  // A cubic between two entries, with the slopes to their neighbours.
  const double place = std::max(radius, 0.0) / kSpacing;
  const auto k = std::min(static_cast<std::size_t>(place), table.size() - 2);
  const double s = place - static_cast<double>(k);
  for (auto member : kMembers) {
    const auto entry = [&](std::size_t i) { return table[std::min(i, table.size() - 1)].*member; };
    const double left = entry(k), right = entry(k + 1),
                 first = k == 0 ? right - left : (right - entry(k - 1)) / 2,
                 last = k + 2 == table.size() ? right - left : (entry(k + 2) - left) / 2,
                 rise = right - left;
    const double b = 3 * rise - 2 * first - last, a = first + last - 2 * rise;
    result.value.*member = left + s * (first + s * (b + s * a));
    result.slope.*member = (first + s * (2 * b + 3 * s * a)) / kSpacing;
  }
  return result;
}

}  // namespace traceraft::discs
