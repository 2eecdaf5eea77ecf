#include "kernel/flow/harmonic_transform.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "kernel/flow/legendre.hpp"

namespace traceraft::flow {
namespace {

// Lagrange's polynomials of the places 0, 1, …, 7 at x.
template <std::size_t N>
std::array<double, N> lagrange_weights(double x) {
  std::array<double, N> weight;
  for (std::size_t i = 0; i < N; ++i) {
    weight[i] = 1;
    for (std::size_t j = 0; j < N; ++j)
      if (j != i)
        weight[i] *=
            (x - static_cast<double>(j)) / (static_cast<double>(i) - static_cast<double>(j));
  }
  return weight;
}

// Sums over points are made in this many parts, whatever the number of threads.
constexpr int kParts = 8;

}  // namespace

Eigen::MatrixXd waves_at(int angles, int degree) {
  Eigen::MatrixXd waves(angles, 2 * degree + 1);
  for (int j = 0; j < angles; ++j) {
    waves(j, 0) = 1 / std::sqrt(2 * kPi);
    for (int m = 1; m <= degree; ++m) {
      const double angle = 2 * kPi * ((static_cast<long long>(j) * m) % angles) / angles;
      waves(j, wave_index(m)) = std::cos(angle) / std::sqrt(kPi);
      waves(j, wave_index(-m)) = std::sin(angle) / std::sqrt(kPi);
    }
  }
  return waves;
}

HarmonicTransform::HarmonicTransform(const std::vector<Point>& points, int degree,
                                     std::shared_ptr<const ThreadTeam> team,
                                     std::shared_ptr<const Communicator> ranks)
    : degree_(degree),
      team_(std::move(team)),
      ranks_(std::move(ranks)),
      rings_(2 * (degree + 1)),
      columns_(2 * rings_) {
  stencils_.reserve(points.size());
  for (const Point& point : points) stencils_.push_back(stencil_of(point));
  waves_ = waves_at(columns_, degree_);
  for (int m = 0; m <= degree_; ++m) {
    Eigen::MatrixXd values(rings_, degree_ - m + 1);
    for (int i = 0; i < rings_; ++i)
      values.row(i) = legendre(degree_, m, (i + 0.5) * kPi / rings_).transpose();
    legendre_.push_back(std::move(values));
  }
}

HarmonicTransform::Stencil HarmonicTransform::stencil_of(const Point& point) const {
  const double theta = std::atan2(std::hypot(point[0], point[1]), point[2]);
  double phi = std::atan2(point[1], point[0]);
  if (phi < 0) phi += 2 * kPi;
  const double across = theta * rings_ / kPi - 0.5, along = phi * columns_ / (2 * kPi);
  Stencil stencil;
  const int ring = std::clamp(static_cast<int>(std::floor(across)), -1, rings_ - 1),
            column = std::clamp(static_cast<int>(std::floor(along)), 0, columns_ - 1);
  stencil.ring = ring - kBefore + kMargin;
  stencil.column = column - kBefore + kMargin;
  stencil.across = lagrange_weights<kPoints>(across - ring + kBefore);
  stencil.along = lagrange_weights<kPoints>(along - column + kBefore);
  return stencil;
}

HarmonicTransform::Grid HarmonicTransform::spread(VecView values) const {
  std::vector<Grid> part(kParts);
  team_->for_range(kParts, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      part[p] = Grid::Zero(rings_ + 2 * kMargin, columns_ + 2 * kMargin);
      const std::size_t last = stencils_.size() * (p + 1) / kParts;
      for (std::size_t k = stencils_.size() * p / kParts; k < last; ++k) {
        const Stencil& stencil = stencils_[k];
        const Eigen::Map<const Eigen::Matrix<double, 1, kPoints>> along(stencil.along.data());
        const double value = values[static_cast<Eigen::Index>(k)];
        for (int i = 0; i < kPoints; ++i)
          part[p].row(stencil.ring + i).segment<kPoints>(stencil.column) +=
              (value * stencil.across[static_cast<std::size_t>(i)]) * along;
      }
    }
  });
  for (std::size_t p = 1; p < kParts; ++p) part[0] += part[p];
  return std::move(part[0]);
}

// The place of a margin: beyond a pole a meridian goes on, half way round.
HarmonicTransform::Place HarmonicTransform::place_of(int row, int column) const {
  int ring = row - kMargin, along = column - kMargin;
  if (ring < 0 || ring >= rings_) {
    ring = ring < 0 ? -1 - ring : 2 * rings_ - 1 - ring;
    along += columns_ / 2;
  }
  return {ring, (along + columns_) % columns_};
}

HarmonicTransform::Grid HarmonicTransform::folded(const Grid& padded) const {
  Grid grid = Grid::Zero(rings_, columns_);
  for (int i = 0; i < padded.rows(); ++i)
    for (int j = 0; j < padded.cols(); ++j) {
      const Place place = place_of(i, j);
      grid(place.ring, place.column) += padded(i, j);
    }
  return grid;
}

HarmonicTransform::Grid HarmonicTransform::with_margin(const Grid& grid) const {
  Grid padded(rings_ + 2 * kMargin, columns_ + 2 * kMargin);
  for (int i = 0; i < padded.rows(); ++i)
    for (int j = 0; j < padded.cols(); ++j) {
      const Place place = place_of(i, j);
      padded(i, j) = grid(place.ring, place.column);
    }
  return padded;
}

// In the order of the ranks.
HarmonicTransform::Grid HarmonicTransform::summed_over_ranks(Grid grid) const {
  if (ranks_->size() == 1) return grid;
  const std::vector<double> own(grid.data(), grid.data() + grid.size());
  grid.setZero();
  for (const std::vector<double>& part : gather_everywhere(*ranks_, own))
    grid += Eigen::Map<const Grid>(part.data(), grid.rows(), grid.cols());
  return grid;
}

Vec HarmonicTransform::analysis(VecView values) const {
  const Eigen::MatrixXd series = summed_over_ranks(folded(spread(values))) * waves_;
  Vec coefficients(size());
  for (int m = -degree_; m <= degree_; ++m) {
    const int order = std::abs(m);
    const Vec of_degrees =
        legendre_[static_cast<std::size_t>(order)].transpose() * series.col(wave_index(m));
    for (int l = order; l <= degree_; ++l)
      coefficients[harmonic_index(l, m)] = of_degrees[l - order];
  }
  return coefficients;
}

Vec HarmonicTransform::synthesis(const Vec& coefficients) const {
  Eigen::MatrixXd series(rings_, 2 * degree_ + 1);
  for (int m = -degree_; m <= degree_; ++m) {
    const int order = std::abs(m);
    Vec of_degrees(degree_ - order + 1);
    for (int l = order; l <= degree_; ++l)
      of_degrees[l - order] = coefficients[harmonic_index(l, m)];
    series.col(wave_index(m)) = legendre_[static_cast<std::size_t>(order)] * of_degrees;
  }
  const Grid grid = with_margin(series * waves_.transpose());
  Vec values(static_cast<Eigen::Index>(stencils_.size()));
  team_->for_range(stencils_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Stencil& stencil = stencils_[k];
      const Eigen::Map<const Eigen::Matrix<double, 1, kPoints>> along(stencil.along.data());
      double value = 0;
      for (int i = 0; i < kPoints; ++i)
        value += stencil.across[static_cast<std::size_t>(i)] *
                 along.dot(grid.row(stencil.ring + i).segment<kPoints>(stencil.column));
      values[static_cast<Eigen::Index>(k)] = value;
    }
  });
  return values;
}

}  // namespace traceraft::flow
