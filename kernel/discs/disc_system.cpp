#include "kernel/discs/disc_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/core/binary.hpp"
#include "kernel/core/random.hpp"

namespace traceraft::discs {
namespace {

// Streams of draws of this model stand apart from those of others with the same seed.
constexpr std::uint64_t kFirstStream = std::uint64_t{1} << 41;
// Uniform draws of a step begin here; normal ones take those before.
constexpr std::uint64_t kFirstUniform = std::uint64_t{1} << 32;

// A displacement of a walk over the mean distance of neighbours.
constexpr double kWalk = 0.2;
// Gaps shorter than this share of the mean radius do not shorten walks further.
constexpr double kShortestGap = 0.3;
// The displacement of a disc that has no neighbours (rad). Nothing but its place depends on it.
constexpr double kLoneWalk = 0.5 * kPi;

// Discs do not meet that are this many standard deviations of a walk apart.
constexpr double kFarApart = 8;

// In areas at which a disc dissolves: larger ones do not do so within a step.
constexpr double kAboutToDissolve = 4;
// Areas of discs that are smaller than this share of the mean one are as exact as that share is.
constexpr double kSmallShare = 0.1;

constexpr double kSafety = 0.9, kLargestGrowth = 5, kLargestCut = 0.2;
// A step takes at most this share of what is left of a disc's time, at its present rate: longer
// ones are rejected.
constexpr double kShareOfLife = 0.5;
// The power of an area that falls in a straight line, nearly, where a disc dissolves.
constexpr double kPower = 1.75;
// d(A^p)/dA
double power_slope(double area) {
  return kPower * std::pow(area, kPower - 1);
}

Contents contents_of(const DiscState& state) {
  Contents contents{Vec(static_cast<Eigen::Index>(state.discs.size())), state.mass};
  for (std::size_t i = 0; i < state.discs.size(); ++i)
    contents.area[static_cast<Eigen::Index>(i)] = state.discs[i].area;
  return contents;
}

void take_contents(const Contents& contents, DiscState& state) {
  for (std::size_t i = 0; i < state.discs.size(); ++i)
    state.discs[i].area = contents.area[static_cast<Eigen::Index>(i)];
  state.mass = contents.mass;
}

DiscCoordinates coordinates_of(const Contents& contents) {
  return {contents.area.array().pow(kPower).matrix(), contents.mass};
}

Contents contents_at(const DiscCoordinates& at) {
  return {at.power.array().pow(1 / kPower).matrix(), at.mass};
}

DiscCoordinates moved(const DiscCoordinates& from, double step, const DiscCoordinates& rate) {
  return {from.power + step * rate.power, from.mass + step * rate.mass};
}

// d/dt of the coordinates.
bool rate_at(const Ripening& ripening, const Contents& contents, DiscCoordinates& result) {
  Contents rate;
  if (!ripening.rate(contents, rate)) return false;
  result = {contents.area.unaryExpr(&power_slope).cwiseProduct(rate.area), rate.mass};
  return true;
}

}  // namespace

DiscState start_state(const DiscModel& model, const StartingDiscs& start) {
  const Phases phases(model);
  DiscState state;
  state.mass = 4 * kPi * start.background;
  for (const Disc& disc : start.discs) {
    const double beyond_background =
        (1 - start.background) * (disc.area + boundary_mass(model.well, model.epsilon));
    state.mass += beyond_background;
    state.discs.push_back(
        {disc.centre, phases.area_of_mass(beyond_background + start.background * disc.area)});
  }
  return state;
}

DiscSystem::DiscSystem(const DiscModel& model, double tolerance, DiscState start)
    : model_(model),
      ripening_(model),
      motion_(model.membrane),
      tolerance_(tolerance),
      state_(std::move(start)) {
  dissolve_small_discs();
  merge_touching_discs();
  plan_walk();
  ripening_.set_places(state_.discs);
}

double DiscSystem::background(const DiscState& state) const {
  return ripening_.background(contents_of(state));
}

double DiscSystem::energy(const DiscState& state) const {
  double sum = 0, covered = 0;
  for (const Disc& disc : state.discs) {
    const double c = phases().inside(phases().potential(disc.area));
    sum += phases().boundary_energy(disc.area) + disc.area * model_.well.energy(c);
    covered += disc.area;
  }
  return sum + (4 * kPi - covered) * model_.well.energy(background(state));
}

// Discs walk next when they have wandered a share of the distance to their neighbours.
void DiscSystem::plan_walk() {
  last_walk_ = state_.t;
  next_walk_ = std::numeric_limits<double>::infinity();
  if (motion_.none() || state_.discs.empty()) return;
  double radii = 0, gaps = 0;
  for (const Disc& disc : state_.discs) radii += half_angle(disc.area);
  const auto count = static_cast<double>(state_.discs.size());
  for (std::size_t i = 0; i < state_.discs.size(); ++i) {
    double nearest = kPi;
    for (std::size_t j = 0; j < state_.discs.size(); ++j)
      if (i != j && least_gap(state_.discs[i], state_.discs[j]) < nearest)
        nearest = std::min(nearest, gap(state_.discs[i], state_.discs[j]));
    gaps += std::max(nearest, kShortestGap * radii / count);
  }
  const double length = state_.discs.size() == 1 ? kLoneWalk : kWalk * gaps / count;
  next_walk_ = last_walk_ + length * length / motion_.largest_variance(state_.discs);
}

// A small disc that dissolves within the step does not shorten it.
bool DiscSystem::attempt(const Ripening& ripening, const DiscState& from,
                         const DiscCoordinates& first, double step, Attempt& result) const {
  const Contents before = contents_of(from);
  const DiscCoordinates start = coordinates_of(before);
  const double shortest = phases().smallest_area(), least = std::pow(0.5 * shortest, kPower);
  const auto after = [&](const DiscCoordinates& at, double time, const DiscCoordinates& rate) {
    DiscCoordinates next = moved(at, time, rate);
    next.power = next.power.cwiseMax(least);
    return contents_at(next);
  };
  DiscCoordinates second, third, last;
  if (!rate_at(ripening, after(start, step / 2, first), second) ||
      !rate_at(ripening, after(start, 0.75 * step, second), third))
    return false;
  const Contents end =
      after(moved(moved(start, step * 2 / 9, first), step / 3, second), step * 4 / 9, third);
  if (!rate_at(ripening, end, last)) return false;
  double error = 0;
  const double small = kSmallShare * end.area.mean();
  for (Eigen::Index i = 0; i < before.area.size(); ++i)
    if (end.area[i] > shortest || before.area[i] > kAboutToDissolve * shortest) {
      const double off = step * (-5 * first.power[i] / 72 + second.power[i] / 12 +
                                 third.power[i] / 9 - last.power[i] / 8);
      error = std::max(error, std::fabs(off) / power_slope(end.area[i]) /
                                  (tolerance_ * std::max(end.area[i], small)));
    }
  result = {end, last, error};
  return std::isfinite(error);
}

// No disc that is not small dissolves within a step: half of the area below which it may is left.
double DiscSystem::longest_step() const {
  const double small = kAboutToDissolve * phases().smallest_area();
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < state_.discs.size(); ++i) {
    const double area = state_.discs[i].area, rate = rate_.power[static_cast<Eigen::Index>(i)];
    if (rate < 0 && area > small)
      step = std::min(
          step, kShareOfLife * (std::pow(0.5 * small, kPower) - std::pow(area, kPower)) / rate);
  }
  return step;
}

Status DiscSystem::advance(double t_end) {
  const double end = std::min(t_end, next_walk_), left = end - state_.t,
               shortest = 1e-14 * std::max(t_end, 1e-300);
  double step = next_step_ > 0 ? next_step_ : 1e-6 * left;
  if (rate_.power.size() == 0 && !rate_at(ripening_, contents_of(state_), rate_))
    return Status::fatal("the areas of these discs cannot change");
  step = std::min(step, longest_step());
  Attempt taken;
  while (true) {
    step = std::min(step, left);
    const bool solved = attempt(ripening_, state_, rate_, step, taken);
    const double growth = !solved ? kLargestCut
                                  : std::clamp(kSafety / std::cbrt(std::max(taken.error, 1e-12)),
                                               kLargestCut, kLargestGrowth);
    if (solved && taken.error <= 1) {
      next_step_ = std::max(step == left ? next_step_ : 0, step * growth);
      break;
    }
    ++statistics_.rejected;
    step *= std::min(growth, 0.9);
    next_step_ = step;
    if (step < shortest) return Status::fatal("the areas of discs change too fast to follow");
  }
  take_contents(taken.contents, state_);
  state_.t = step == left ? end : state_.t + step;
  step_ = step;
  ++statistics_.steps;
  rate_ = std::move(taken.rate);
  const std::size_t count = state_.discs.size();
  bool walked = false;
  dissolve_small_discs();
  if (state_.t >= next_walk_ || (state_.t >= t_end && !motion_.none())) {
    motion_.set_discs(state_.discs);
    if (!walk(state_.t - last_walk_))
      return Status::fatal("the Brownian displacements of discs have no covariance");
    plan_walk();
    walked = true;
  }
  merge_touching_discs();
  if (walked || state_.discs.size() < count) {
    ripening_.set_places(state_.discs);
    rate_.power.resize(0);
  }
  return {};
}

// Moves all discs, and merges those that touched on their way.
bool DiscSystem::walk(double time) {
  const std::size_t count = state_.discs.size();
  if (count == 0) return true;
  const auto stream = kFirstStream + static_cast<std::uint64_t>(statistics_.walks);
  Vec normal(static_cast<Eigen::Index>(2 * count));
  for (Eigen::Index k = 0; k < normal.size(); ++k)
    normal[k] = normal_random(model_.seed, stream, static_cast<std::uint64_t>(k));
  const std::vector<Point> displacement = motion_.displacements(time, normal);
  if (displacement.empty()) return false;
  std::vector<Disc> start = state_.discs;
  for (std::size_t i = 0; i < count; ++i) {
    const double length = displacement[i].norm();
    if (length == 0) continue;
    state_.discs[i].centre =
        (std::cos(length) * start[i].centre + std::sin(length) / length * displacement[i])
            .normalized();
  }
  std::vector<std::size_t> merged_into(count);
  for (std::size_t i = 0; i < count; ++i) merged_into[i] = i;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (merged_into[i] == i && merged_into[j] == j && touched_between(i, j, start, time)) {
        merged_into[i] = j;
        merge(j, i);
      }
  std::vector<Disc> left;
  for (std::size_t i = 0; i < count; ++i)
    if (merged_into[i] == i) left.push_back(state_.discs[i]);
  state_.discs = std::move(left);
  ++statistics_.walks;
  return true;
}

// A Brownian path from the one distance to the other has touched 0 with the probability
// exp(−2 · both/(variance of their distance)).
bool DiscSystem::touched_between(std::size_t i, std::size_t j, const std::vector<Disc>& start,
                                 double time) const {
  const double contact = phases().contact_distance(),
               far = kFarApart * std::sqrt(motion_.variance_of_distance(i, j) * time);
  if (least_gap(start[i], start[j]) - contact > far) return false;
  const double first = gap(start[i], start[j]) - contact;
  if (first > far) return false;
  const double last = gap(state_.discs[i], state_.discs[j]) - contact;
  if (first <= 0 || last <= 0) return true;
  const double chance = std::exp(-2 * first * last / (motion_.variance_of_distance(i, j) * time));
  if (chance < 1e-12) return false;
  const auto stream = kFirstStream + static_cast<std::uint64_t>(statistics_.walks);
  return uniform_random(model_.seed, stream, kFirstUniform + i * state_.discs.size() + j) < chance;
}

// Their lipids go to the phase outside, which holds what discs do not.
void DiscSystem::dissolve_small_discs() {
  const auto small = [&](const Disc& disc) { return disc.area < phases().smallest_area(); };
  const auto first = std::remove_if(state_.discs.begin(), state_.discs.end(), small);
  statistics_.dissolved += state_.discs.end() - first;
  state_.discs.erase(first, state_.discs.end());
}

// The second disc is left to be removed. Both hold what they held, at the centre of both.
void DiscSystem::merge(std::size_t kept, std::size_t gone) {
  Disc& disc = state_.discs[kept];
  const Disc& other = state_.discs[gone];
  const double own = phases().mass(disc.area), others = phases().mass(other.area);
  disc.centre = (own * disc.centre + others * other.centre).normalized();
  disc.area = phases().area_of_mass(own + others);
  ++statistics_.merged;
}

void DiscSystem::merge_touching_discs() {
  std::vector<Disc>& discs = state_.discs;
  const double contact = phases().contact_distance();
  const auto are_apart = [&](const Disc& x, const Disc& y) {
    return least_gap(x, y) > contact || gap(x, y) > contact;
  };
  for (std::size_t i = 0; i < discs.size();) {
    std::size_t j = 0;
    while (j < i && are_apart(discs[i], discs[j])) ++j;
    if (j == i) {
      ++i;
      continue;
    }
    merge(j, i);
    discs.erase(discs.begin() + static_cast<std::ptrdiff_t>(i));
    i = j;  // it is held against all before it, then those behind against it
  }
}

void DiscSystem::save(std::ostream& out) const {
  write_binary(out, state_.t);
  write_binary(out, state_.mass);
  write_binary(out, static_cast<std::uint64_t>(state_.discs.size()));
  for (const Disc& disc : state_.discs)
    for (const double number : {disc.centre[0], disc.centre[1], disc.centre[2], disc.area})
      write_binary(out, number);
  write_binary(out, step_);
  write_binary(out, next_step_);
  write_binary(out, last_walk_);
  write_binary(out, next_walk_);
  write_binary(out, statistics_);
  write_binary(out, rate_.mass);
  for (const Vec* numbers : {&rate_.power, &ripening_.charges()}) {
    write_binary(out, static_cast<std::int64_t>(numbers->size()));
    write_binary(out, *numbers);
  }
}

void DiscSystem::load(std::istream& in) {
  std::uint64_t count = 0;
  read_binary(in, state_.t);
  read_binary(in, state_.mass);
  read_binary(in, count);
  state_.discs.clear();
  for (std::uint64_t k = 0; k < count; ++k) {
    std::array<double, 4> numbers;
    read_binary(in, numbers);
    state_.discs.push_back({{numbers[0], numbers[1], numbers[2]}, numbers[3]});
  }
  read_binary(in, step_);
  read_binary(in, next_step_);
  read_binary(in, last_walk_);
  read_binary(in, next_walk_);
  read_binary(in, statistics_);
  read_binary(in, rate_.mass);
  Vec charges;
  for (Vec* numbers : {&rate_.power, &charges}) {
    std::int64_t size = 0;
    read_binary(in, size);
    read_binary(in, *numbers, size);
  }
  ripening_.set_places(state_.discs);
  ripening_.set_charges(std::move(charges));
}

}  // namespace traceraft::discs
