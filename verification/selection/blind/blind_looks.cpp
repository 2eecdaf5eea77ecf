#include "verification/selection/blind/blind_looks.hpp"

#include <cmath>

#include "kernel/core/random.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::selection {
namespace {

// Between `first` and `last`, irregular: equal ratios with a random part of half a ratio.
std::vector<double> snapshot_times(const BlindRequest& request) {
  std::vector<double> times;
  for (int k = 0; k < request.snapshots; ++k) {
    const bool end = k == 0 || k + 1 == request.snapshots;
    const double u =
        end ? 0 : 0.5 * (uniform_random(request.seed, statistics::stream::snapshot_times, k) - 0.5);
    times.push_back(request.first *
                    std::pow(request.last / request.first, (k + u) / (request.snapshots - 1)));
  }
  return times;
}

}  // namespace

Placement::Placement(std::uint64_t seed, double h) {
  const auto u = [&](std::uint64_t i) {
    return uniform_random(seed, statistics::stream::placement, i);
  };
  angle = 2 * kPi * u(0);
  offset = h * Point(u(1) - 0.5, u(2) - 0.5, u(3) - 0.5);
}

Point Placement::in_mesh(const Point& x) const {
  return Eigen::AngleAxisd(angle, Point::UnitZ()) * x + offset;
}

BlindLooks::BlindLooks(const BlindRequest& request)
    : placement(request.seed, 2 * mesh::kBoxHalfWidth / request.cells),
      surface(std::make_shared<geometry::ShiftedLevelSet>(geometry::make_surface("sphere"),
                                                          placement.offset)),
      labels(snapshot_times(request)) {
  for (const double t : labels) times.push_back(request.diffusion_ratio * t);
}

std::vector<Point> BlindLooks::directions(const BlindRequest& request, int snapshot) {
  std::vector<Point> points;
  for (int i = 0; i < request.points; ++i) {
    const auto u = [&](int j) {
      return uniform_random(
          request.seed, statistics::stream::points + static_cast<std::uint64_t>(2 * snapshot + j),
          i);
    };
    points.push_back(uniform_direction(u(0), u(1)));
  }
  return points;
}

}  // namespace traceraft::selection
