#include "verification/assimilation/filter/field_noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "verification/assimilation/filter/correlation_fit.hpp"

namespace traceraft::assimilation {
namespace {

constexpr std::size_t kPatch = 110, kFewestInPatch = 40;
// Standard deviation of a polynomial's coefficients, in units of the noise: as good as unknown.
constexpr double kUnknown = 100;
// Values that are looked at: the noise need not be known better.
constexpr std::size_t kMostPatches = 160;

// Cubic polynomials in the tangent plane, in units of the size of the patch.
Eigen::MatrixXd cubics(const std::vector<Point>& points, const BlockRows& rows) {
  Point middle = Point::Zero();
  for (const Eigen::Index row : rows) middle += points[row] / static_cast<double>(rows.size());
  const Point u = middle.unitOrthogonal(), v = middle.normalized().cross(u);
  double size = 0;
  for (const Eigen::Index row : rows) size = std::max(size, (points[row] - middle).norm());
  Eigen::MatrixXd X(static_cast<Eigen::Index>(rows.size()), 10);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double x = (points[rows[k]] - middle).dot(u) / size;
    const double y = (points[rows[k]] - middle).dot(v) / size;
    X.row(static_cast<Eigen::Index>(k)) << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y,
        x * y * y, y * y * y;
  }
  return X;
}

struct Patch {
  NoiseBlock block;
  double slope;  // standard deviation of the polynomial that fits best
};

Patch patch_of(const FieldSnapshot& snapshot, const BlockRows& rows) {
  const Eigen::MatrixXd X = cubics(snapshot.points, rows);
  const Vec values = snapshot.values(rows);
  const Vec fit = X * X.colPivHouseholderQr().solve(values);
  const double slope = std::sqrt((fit.array() - fit.mean()).square().mean());
  // The best polynomial is taken out, so that numbers stay small.
  return {{values - fit, kUnknown * kUnknown * X * X.transpose(), snapshot.deviation(rows),
           distances(snapshot.points, rows)},
          slope};
}

std::vector<Patch> patches_of(const std::vector<FieldSeries>& series) {
  std::vector<Patch> patches;
  for (const FieldSeries& vesicle : series)
    for (const FieldSnapshot& snapshot : vesicle.snapshots)
      for (const BlockRows& rows : compact_blocks(snapshot.points, kPatch))
        if (rows.size() >= kFewestInPatch) patches.push_back(patch_of(snapshot, rows));
  return patches;
}

std::vector<NoiseBlock> flatter_half(std::vector<Patch> patches) {
  std::vector<double> slopes;
  for (const Patch& patch : patches) slopes.push_back(patch.slope);
  const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
  std::nth_element(slopes.begin(), middle, slopes.end());
  const std::size_t stride = 1 + patches.size() / (2 * kMostPatches);
  std::vector<NoiseBlock> blocks;
  std::size_t flat = 0;
  for (Patch& patch : patches)
    if (patch.slope <= *middle && flat++ % stride == 0) blocks.push_back(std::move(patch.block));
  return blocks;
}

// Values in units of their deviation from the polynomials, which is returned.
double in_units_of_noise(std::vector<NoiseBlock>& blocks) {
  double squares = 0, count = 0;
  for (const NoiseBlock& block : blocks) {
    squares += block.values.cwiseQuotient(block.deviation).squaredNorm();
    count += static_cast<double>(block.values.size());
  }
  const double unit = std::max(std::sqrt(squares / count), 1e-12);
  for (NoiseBlock& block : blocks) block.values /= unit;
  return unit;
}

// The spacing of the points of a snapshot, on average.
double spacing_of(const std::vector<FieldSeries>& series) {
  double squares = 0, count = 0, snapshots = 0;
  for (const FieldSeries& vesicle : series)
    for (const FieldSnapshot& snapshot : vesicle.snapshots) {
      for (const Point& x : snapshot.points) squares += x.squaredNorm();
      count += static_cast<double>(snapshot.points.size());
      ++snapshots;
    }
  return std::sqrt(4 * kPi * squares * snapshots) / count;
}

}  // namespace

std::optional<FieldNoise> noise_of_fields(const std::vector<FieldSeries>& series, int threads) {
  std::vector<Patch> patches = patches_of(series);
  if (patches.size() < 2) return std::nullopt;
  std::vector<NoiseBlock> blocks = flatter_half(std::move(patches));
  const double unit = in_units_of_noise(blocks);
  const CorrelationFit fit = fit_correlation(blocks, spacing_of(series), ThreadTeam(threads));
  double squares = 0, count = 0;
  for (const FieldSeries& vesicle : series)
    for (const FieldSnapshot& snapshot : vesicle.snapshots) {
      squares += snapshot.deviation.squaredNorm();
      count += static_cast<double>(snapshot.deviation.size());
    }
  return FieldNoise{unit * std::sqrt(fit.variance * squares / count), fit.correlation};
}

}  // namespace traceraft::assimilation
