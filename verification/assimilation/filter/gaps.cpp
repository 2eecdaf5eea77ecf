#include "verification/assimilation/filter/gaps.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace traceraft::assimilation {
namespace {

double square(double x) {
  return x * x;
}

double squares_of_gap(const Innovation& in) {
  return in.noise.cwiseProduct(in.gap).squaredNorm();
}

Gaps over_snapshots(const FilterResult& pass,
                    const std::function<double(const Innovation&)>& squares) {
  return {root_mean_square(pass.innovations, false, squares),
          root_mean_square(pass.innovations, true, squares)};
}

}  // namespace

std::optional<double> share_closed(double base, double found, double floor) {
  constexpr double kTold = 1.02;
  if (!(floor > 0 && base > kTold * floor)) return std::nullopt;
  return std::min(1.0, (square(base) - square(found)) / (square(base) - square(floor)));
}

SharesClosed shares_closed(const Gaps& base, const Gaps& found, const Gaps& floor) {
  return {share_closed(base.train, found.train, floor.train),
          share_closed(base.heldout, found.heldout, floor.heldout)};
}

Gaps gaps_of_pass(const FilterResult& pass) {
  return over_snapshots(pass, squares_of_gap);
}

Gaps expected_gaps(const FilterResult& pass) {
  return over_snapshots(pass, [](const Innovation& in) { return in.expected_squares; });
}

Gaps random_gaps(const FilterResult& pass) {
  return over_snapshots(pass, [](const Innovation& in) { return in.random_squares; });
}

std::vector<SnapshotGap> snapshot_gaps(const FilterResult& pass) {
  std::vector<SnapshotGap> gaps;
  for (const Innovation& in : pass.innovations) {
    const auto count = static_cast<double>(in.values.size());
    gaps.push_back({in.vesicle, in.snapshot, std::sqrt(squares_of_gap(in) / count),
                    std::sqrt(in.expected_squares / count)});
  }
  return gaps;
}

}  // namespace traceraft::assimilation
