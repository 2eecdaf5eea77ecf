#include "verification/assimilation/fields/noise_correlation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "kernel/core/text.hpp"

namespace traceraft::assimilation {
namespace {

using GridCell = std::array<int, 3>;

GridCell grid_cell_of(const Point& x, double size) {
  GridCell cell{};
  for (int d = 0; d < 3; ++d) cell[d] = static_cast<int>(std::floor(x[d] / size));
  return cell;
}

Eigen::SparseMatrix<double> correlation_matrix(const std::vector<Point>& points,
                                               const NoiseCorrelation& correlation) {
  const double reach = correlation.support();
  std::map<GridCell, std::vector<int>> cells;
  for (std::size_t i = 0; i < points.size(); ++i)
    cells[grid_cell_of(points[i], reach)].push_back(static_cast<int>(i));
  std::vector<Eigen::Triplet<double>> entries;
  const auto couple = [&](int i, const std::vector<int>& others) {
    for (const int j : others) {
      const double distance = (points[i] - points[j]).norm();
      if (i != j && distance < reach) entries.emplace_back(i, j, correlation.at(distance));
    }
  };
  for (const auto& [cell, own] : cells)
    for (int k = 0; k < 27; ++k) {
      const auto near =
          cells.find({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
      if (near == cells.end()) continue;
      for (const int i : own) couple(i, near->second);
    }
  const auto n = static_cast<int>(points.size());
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
  Eigen::SparseMatrix<double> R(n, n);
  R.setFromTriplets(entries.begin(), entries.end());
  return R;
}

}  // namespace

double wendland(double r) {
  if (r >= 1) return 0;
  const double square = (1 - r) * (1 - r), fourth = square * square;
  return fourth * fourth * (r * (r * (32 * r + 25) + 8) + 1);
}

bool operator==(const NoiseCorrelation& a, const NoiseCorrelation& b) {
  const auto same = [](const NoiseCorrelation::Component& p, const NoiseCorrelation::Component& q) {
    return p.support == q.support && p.share == q.share;
  };
  return a.at_bound == b.at_bound && a.error == b.error &&
         std::equal(a.components.begin(), a.components.end(), b.components.begin(),
                    b.components.end(), same);
}

double NoiseCorrelation::share() const {
  double sum = 0;
  for (const Component& c : components) sum += c.share;
  return sum;
}

double NoiseCorrelation::length() const {
  if (white()) return 0;
  double squares = 0;
  for (const Component& c : components)
    squares += c.share * std::pow(kWendlandLength * c.support, 2);
  return std::sqrt(squares / share());
}

double NoiseCorrelation::at(double distance) const {
  double sum = 0;
  for (const Component& c : components) sum += c.share * wendland(distance / c.support);
  return sum;
}

double NoiseCorrelation::support() const {
  double most = 0;
  for (const Component& c : components) most = std::max(most, c.support);
  return most;
}

std::string text_of(const NoiseCorrelation& correlation) {
  if (correlation.white()) return "white";
  return formatted("%.0f %% of its variance is correlated, over %.2g R%s",
                   100 * correlation.share(), correlation.length(),
                   correlation.at_bound ? " or more" : "");
}

NoiseCorrelation gaussian_correlation(double length, double share) {
  return {{{length / kWendlandLength, share}}};
}

NoiseWhitening::NoiseWhitening(const std::vector<Point>& points,
                               const NoiseCorrelation& correlation)
    : R_(correlation_matrix(points, correlation)), factors_(R_) {}

Eigen::MatrixXd NoiseWhitening::whitened(const Eigen::MatrixXd& X) const {
  if (X.cols() == 0) return X;
  const std::lock_guard lock(one_at_a_time_);
  return factors_.whitened(X);
}

Eigen::MatrixXd NoiseWhitening::coloured(const Eigen::MatrixXd& Z) const {
  if (Z.cols() == 0) return Z;
  const std::lock_guard lock(one_at_a_time_);
  return factors_.coloured(Z);
}

WhiteningPtr whitening(const std::vector<Point>& points, const NoiseCorrelation& correlation) {
  if (correlation.white()) return nullptr;
  return std::make_shared<const NoiseWhitening>(points, correlation);
}

}  // namespace traceraft::assimilation
