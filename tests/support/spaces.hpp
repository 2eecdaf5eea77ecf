// Small spaces, problems and states for tests.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernel/core/random.hpp"
#include "kernel/problem/cahn_hilliard.hpp"
#include "kernel/problem/initial_data.hpp"

namespace traceraft::testing {

inline std::shared_ptr<const fem::SurfaceSpace> make_space(int cells,
                                                           const std::string& surface = "sphere",
                                                           int threads = 1,
                                                           const Point& offset = Point::Zero()) {
  return std::make_shared<fem::SurfaceSpace>(
      std::make_shared<geometry::ShiftedLevelSet>(geometry::make_surface(surface), offset), cells,
      std::make_shared<ThreadTeam>(threads), std::make_shared<SerialCommunicator>());
}

inline problem::CahnHilliardModel make_model(const std::string& mobility = "degenerate",
                                             double epsilon = 0.2) {
  problem::CahnHilliardModel model;
  model.mobility = physics::make_mobility(mobility);
  model.epsilon = epsilon;
  return model;
}

inline Point random_direction(std::uint64_t seed, std::uint64_t index) {
  return uniform_direction(uniform_random(seed, 1, index), uniform_random(seed, 2, index));
}

inline std::vector<Point> random_directions(int count) {
  std::vector<Point> points;
  for (int k = 0; k < count; ++k)
    points.push_back(random_direction(3, static_cast<std::uint64_t>(k)));
  return points;
}

// Uniform in [low, high], the same on every machine.
inline Vec random_vector(Eigen::Index size, std::uint64_t seed, double low = -1, double high = 1) {
  Vec v(size);
  for (Eigen::Index i = 0; i < size; ++i)
    v[i] = low + (high - low) * uniform_random(seed, 77, static_cast<std::uint64_t>(i));
  return v;
}

// A state whose concentrations lie inside and outside of [0, 1].
inline Vec random_state(const problem::DaeProblem& problem, std::uint64_t seed) {
  Vec y(problem.size());
  y.head(problem.block_size()) = random_vector(problem.block_size(), seed, -0.2, 1.2);
  y.tail(problem.block_size()) = random_vector(problem.block_size(), seed + 1000);
  return y;
}

// Consistent state of projected 50:50 noise.
struct StartState {
  Vec y, ydot;
};
inline StartState noise_state(const problem::CahnHilliard& problem, std::uint64_t seed = 1,
                              double fraction = 0.5) {
  problem::InitialRequest request;
  request.raft_fraction = fraction;
  request.seed = seed;
  StartState start{Vec::Zero(problem.size()), Vec::Zero(problem.size())};
  start.y.head(problem.block_size()) =
      problem::make_initial_field("noise", problem.space(), request);
  const Status status = problem.consistent_initial_state(0, start.y, start.ydot);
  if (!status.ok()) throw std::runtime_error(status.why);
  return start;
}

}  // namespace traceraft::testing
