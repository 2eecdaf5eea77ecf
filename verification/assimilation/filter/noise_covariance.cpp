#include <algorithm>
#include <cmath>

#include "verification/assimilation/filter/correlation_fit.hpp"
#include "verification/assimilation/filter/noise_levels.hpp"

namespace traceraft::assimilation {
namespace {

// Larger blocks tell more of long correlations, and take longer.
constexpr std::size_t kLargestBlock = 160;
// The most values that all blocks may have together. Of more, every other block or so is used.
constexpr double kMostValues = 40000;
// Correlations are as they were if what they add to the noise of smooth patterns is, to that share.
constexpr double kUnchanged = 0.02;

// Columns per value, in c.
Columns in_c(const Innovation& in, const Columns& X) {
  return in.noise.asDiagonal() * at_points(in, X);
}

// The blocks of one snapshot. Errors of the state and of the model are as large as they seem to be.
std::vector<NoiseBlock> blocks_of(const Innovation& in, const std::vector<Point>& points) {
  Columns directions = in_c(in, in.directions);
  directions.rightCols(directions.cols() - in.state_directions) *= in.model_error;
  const Vec values = in_c(in, in.values);
  std::vector<NoiseBlock> blocks;
  for (const BlockRows& rows : compact_blocks(points, kLargestBlock)) {
    const Columns own = directions(rows, Eigen::all);
    blocks.push_back(
        {values(rows), own * own.transpose(), in.noise(rows), distances(points, rows)});
  }
  return blocks;
}

std::vector<NoiseBlock> some_of(std::vector<NoiseBlock> blocks) {
  double values = 0;
  for (const NoiseBlock& block : blocks) values += static_cast<double>(block.values.size());
  const auto stride = static_cast<std::size_t>(std::ceil(values / kMostValues));
  std::vector<NoiseBlock> some;
  for (std::size_t b = 0; b < blocks.size(); b += stride) some.push_back(std::move(blocks[b]));
  return some;
}

// Variance of the mean of many values over that of white noise, at a density of values.
double inflation(const NoiseCorrelation& correlation, double density) {
  const double length = correlation.length();
  return 1 - correlation.share() + correlation.share() * 2 * kPi * length * length * density;
}

bool is_as_before(const NoiseCorrelation& now, const NoiseCorrelation& before, double density) {
  if (now.white() && before.white()) return true;
  return std::fabs(std::log(inflation(now, density) / inflation(before, density))) < kUnchanged &&
         std::fabs(now.share() - before.share()) < kUnchanged;
}

}  // namespace

bool operator==(const NoiseModel& a, const NoiseModel& b) {
  return a.levels == b.levels && a.first == b.first && a.correlation == b.correlation;
}

NoiseModel noise_model(const FilterProblems& data) {
  NoiseModel noise;
  for (const FilterProblem& vesicle : data) {
    noise.levels.push_back(vesicle.noise);
    noise.first.push_back(vesicle.first_noise);
  }
  noise.correlation = data.front().correlation;
  return noise;
}

void set_noise_model(const NoiseModel& noise, const problem::CahnHilliardModel& base,
                     const FilterSettings& settings, FilterProblems& data) {
  for (FilterProblem& vesicle : data) {
    const double first = noise.first[vesicle.vesicle];
    const bool white = noise.correlation.white() && vesicle.correlation.white();
    if (!white && !(noise.correlation == vesicle.correlation && first == vesicle.first_noise)) {
      vesicle.noise.front() = first;
      set_correlation(noise.correlation, base, settings, vesicle);
    }
    vesicle.noise = noise.levels[vesicle.vesicle];
    vesicle.first_noise = first;
  }
}

bool fit_noise_covariance(FilterProblems& data, const FilterResult& pass,
                          const problem::CahnHilliardModel& base, const FilterSettings& settings) {
  const ThreadTeam& team = *data.front().team;
  std::vector<NoiseBlock> counting;
  std::vector<std::vector<NoiseBlock>> all;
  double spacing = 0;
  for (const Innovation& in : pass.innovations) {
    const FilterProblem& vesicle = data[in.vesicle];
    const std::vector<Point>& points = vesicle.series.snapshots[in.snapshot].points;
    all.push_back(blocks_of(in, points));
    spacing =
        std::max(spacing, std::sqrt(vesicle.space->area / static_cast<double>(points.size())));
    if (!in.held_out) counting.insert(counting.end(), all.back().begin(), all.back().end());
  }
  const NoiseCorrelation before = data.front().correlation;
  NoiseCorrelation now = fit_correlation(some_of(std::move(counting)), spacing, team).correlation;
  if (now.white() && before.white()) {
    fit_noise(data, pass);
    return false;
  }
  const bool same = is_as_before(now, before, 1 / (spacing * spacing));
  if (same) now = before;  // which the first field and the pass belong to
  std::vector<std::vector<double>> own(data.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Innovation& in = pass.innovations[k];
    own[in.vesicle].push_back(data[in.vesicle].noise[in.snapshot] *
                              std::sqrt(fit_variance(all[k], now, team)));
  }
  set_noise(data, own);
  if (!same)
    for (FilterProblem& vesicle : data) set_correlation(now, base, settings, vesicle);
  return !same;
}

}  // namespace traceraft::assimilation
