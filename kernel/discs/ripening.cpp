#include "kernel/discs/ripening.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace traceraft::discs {
namespace {

double uncovered(const Vec& area) {
  return 4 * kPi - area.sum();
}

}  // namespace

void Ripening::set_places(const std::vector<Disc>& discs) {
  const auto count = static_cast<Eigen::Index>(discs.size());
  logarithms_.resize(count, count);
  angles_.resize(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const Point chord =
          discs[static_cast<std::size_t>(i)].centre - discs[static_cast<std::size_t>(j)].centre;
      logarithms_(i, j) = std::log(0.25 * chord.squaredNorm());  // 1 − cos θ = |x − y|²/2
      angles_(i, j) = 2 * std::asin(std::min(1.0, 0.5 * chord.norm()));
    }
}

Vec Ripening::half_angles_with_tails(const Vec& area) const {
  constexpr double kShare = 0.45;  // of the gap to a neighbour
  Vec angle = area.unaryExpr([](double a) { return half_angle(a); });
  Vec tail = area.unaryExpr([&](double a) { return phases_.tail(phases_.potential(a)); });
  for (Eigen::Index i = 0; i < area.size(); ++i) {
    tail[i] = std::min(tail[i], kShare * (kPi - angle[i]));
    for (Eigen::Index j = 0; j < i; ++j) {
      const double room = kShare * std::max(0.0, angles_(i, j) - angle[i] - angle[j]);
      tail[i] = std::min(tail[i], room);
      tail[j] = std::min(tail[j], room);
    }
  }
  return angle + tail;
}

bool Ripening::rate(const Contents& contents, Contents& result) const {
  const Eigen::Index count = contents.area.size();
  const double outside = uncovered(contents.area);
  if (!(outside > 0) || (count > 0 && !(contents.area.minCoeff() > 0))) return false;
  const double around = background(contents);
  const Vec angle = half_angles_with_tails(contents.area);
  // ln((1 + cos α)/2) = 2 ln cos(α/2)
  const Vec caps = angle.unaryExpr([](double a) { return 2 * std::log(std::cos(a / 2)); });
  const Vec potential = contents.area.unaryExpr([&](double area) {
    return phases_.flux_potential(phases_.outside(phases_.potential(area)));
  });
  Eigen::MatrixXd green(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < i; ++j)
      green(i, j) = -(logarithms_(i, j) + caps[i] + caps[j] + 1) / (4 * kPi);
    green(i, i) = -(2 * std::log(std::sin(angle[i] / 2)) + caps[i] + 1) / (4 * kPi);
  }
  // The potential inside a disc is that of its boundary.
  const double mean =
      (outside * phases_.flux_potential(around) + contents.area.dot(potential)) / (4 * kPi);
  const Eigen::LLT<Eigen::MatrixXd> factors(green);
  if (factors.info() != Eigen::Success) return false;
  const Vec flux = factors.solve((mean - potential.array()).matrix());
  result.area.resize(count);
  for (Eigen::Index i = 0; i < count; ++i)
    result.area[i] = flux[i] / (phases_.mass_slope(contents.area[i]) - around);
  result.mass = uptake_ * (4 * kPi - contents.mass);
  return result.area.allFinite();
}

double Ripening::background(const Contents& contents) const {
  double rest = contents.mass;
  for (const double area : contents.area) rest -= phases_.mass(area);
  return rest / uncovered(contents.area);
}

}  // namespace traceraft::discs
