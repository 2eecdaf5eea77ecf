#include "kernel/discs/random_discs.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "kernel/core/error.hpp"
#include "kernel/core/random.hpp"
#include "kernel/discs/phases.hpp"

namespace traceraft::discs {
namespace {

enum Stream : std::uint64_t { kAreaStream = 3, kPlaceStream = 4 };
constexpr std::uint64_t kTries = 10000;  // of each disc

// The phase outside that is in equilibrium with a disc, by Newton's method.
double background_beside(double area, const physics::DoubleWell& well, double epsilon) {
  const double potential = epsilon * well.interface_energy() * curvature(area);
  double c = 0;
  for (int k = 0; k < 20; ++k) c -= (well.derivative(c) - potential) / well.second(c);
  return c;
}

// The area of all discs together, and the background: the mean of c is the one asked for.
std::pair<double, double> covered_and_background(const RandomDiscs& request) {
  const double held = request.number * boundary_mass(request.well, request.epsilon);
  double covered = 4 * kPi * request.raft_fraction - held, background = 0;
  for (int k = 0; k < 50 && covered > 0; ++k) {
    background = background_beside(covered / request.number, request.well, request.epsilon);
    covered = 4 * kPi * (request.raft_fraction - background) / (1 - background) - held;
    if (!(background >= 0 && background < request.raft_fraction)) covered = -1;
  }
  return {covered, background};
}

std::vector<double> random_areas(const RandomDiscs& request, double covered) {
  std::vector<double> areas;
  double sum = 0;
  for (int k = 0; k < request.number; ++k) {
    areas.push_back(std::exp(
        request.spread * normal_random(request.seed, kAreaStream, static_cast<std::uint64_t>(k))));
    sum += areas.back();
  }
  for (double& area : areas) area *= covered / sum;
  std::sort(areas.rbegin(), areas.rend());
  return areas;
}

}  // namespace

StartingDiscs random_discs(const RandomDiscs& request) {
  const double contact = contact_distance(request.well, request.epsilon);
  const auto [covered, background] = covered_and_background(request);
  if (!(covered > 0))
    throw InputError("initial 'discs': " + std::to_string(request.number) +
                     " discs would be smaller than their boundaries are wide; choose fewer, or a "
                     "smaller epsilon");
  std::vector<Disc> discs;
  for (const double area : random_areas(request, covered)) {
    const std::uint64_t first = kTries * discs.size();
    bool placed = false;
    for (std::uint64_t k = 0; k < kTries && !placed; ++k) {
      const Disc disc{
          uniform_direction(uniform_random(request.seed, kPlaceStream, 2 * (first + k)),
                            uniform_random(request.seed, kPlaceStream, 2 * (first + k) + 1)),
          area};
      placed = std::all_of(discs.begin(), discs.end(),
                           [&](const Disc& other) { return gap(disc, other) > contact; });
      if (placed) discs.push_back(disc);
    }
    if (!placed)
      throw InputError("initial 'discs': there is no room for " + std::to_string(request.number) +
                       " discs that do not touch; choose fewer, or a smaller raft fraction");
  }
  return {discs, background};
}

}  // namespace traceraft::discs
