#include "kernel/observables/disc_observables.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace traceraft::observables {
namespace {

std::vector<discs::Disc> largest_first(const discs::DiscState& state) {
  std::vector<discs::Disc> discs = state.discs;
  std::stable_sort(discs.begin(), discs.end(),
                   [](const discs::Disc& a, const discs::Disc& b) { return a.area > b.area; });
  return discs;
}

}  // namespace

Observables observe(const discs::DiscSystem& system, const discs::DiscState& state) {
  Observables row;
  row.t = state.t;
  row.mass = state.mass;
  row.energy = system.energy(state);
  row.c_min = row.c_max = system.background(state);
  double covered = 0;
  for (const discs::Disc& disc : state.discs) {
    row.perimeter += system.phases().diffuse_perimeter(disc.area);
    row.perimeter_level += discs::perimeter(disc.area);
    covered += disc.area;
    row.largest_raft = std::max(row.largest_raft, disc.area);
    row.c_max = std::max(row.c_max, system.phases().inside(system.phases().potential(disc.area)));
  }
  row.rafts = static_cast<int>(state.discs.size());
  row.raft_fraction = covered / (4 * kPi);
  // The phase outside is in one piece.
  row.domains = row.raft_fraction > 0.5 ? 1 : row.rafts;
  return row;
}

RaftReport raft_report(const discs::DiscSystem& system, const discs::DiscState& state) {
  RaftReport report;
  for (const discs::Disc& disc : largest_first(state)) {
    const double cosine = discs::cosine_of_half_angle(disc.area), height = 0.5 * (1 + cosine);
    report.rafts.push_back(
        {disc.area, discs::perimeter(disc.area), height * disc.centre, 1 - height});
  }
  const Observables row = observe(system, state);
  report.area = 4 * kPi * row.raft_fraction;
  report.perimeter = row.perimeter_level;
  report.c_min = row.c_min;
  report.c_max = row.c_max;
  return report;
}

DiscField::DiscField(const discs::DiscSystem& system, const discs::DiscState& state)
    : background_(system.background(state)),
      epsilon_(system.model().epsilon),
      well_(system.model().well) {
  const discs::Phases& phases = system.phases();
  for (const discs::Disc& disc : largest_first(state))
    caps_.push_back(
        {disc.centre, discs::half_angle(disc.area), phases.inside(phases.potential(disc.area))});
}

std::pair<double, std::size_t> DiscField::nearest(const Point& direction) const {
  double distance = 4 * kPi;
  std::size_t whose = 0;
  for (std::size_t k = 0; k < caps_.size(); ++k) {
    const double own = discs::angle_between(direction, caps_[k].centre) - caps_[k].angle;
    if (own < distance) {
      distance = own;
      whose = k;
    }
  }
  return {distance, whose};
}

double DiscField::concentration(const Point& direction) const {
  if (caps_.empty()) return background_;
  const auto [distance, whose] = nearest(direction);
  const double share = (well_.profile(distance, epsilon_) - well_.a) / (well_.b - well_.a);
  return background_ + share * (caps_[whose].inside - background_);
}

int DiscField::raft(const Point& direction) const {
  const auto [distance, whose] = nearest(direction);
  return distance < 0 ? static_cast<int>(whose) + 1 : 0;
}

}  // namespace traceraft::observables
