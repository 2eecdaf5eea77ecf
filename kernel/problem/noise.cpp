#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "kernel/core/random.hpp"
#include "kernel/problem/initial_data.hpp"

namespace traceraft::problem {
namespace {

enum Stream : std::uint64_t { kBernoulliStream = 1, kWaveStream = 2 };

// A vertex of the fine mesh in the P1 space of a coarser Kuhn mesh of the same cube.
struct Interpolation {
  std::array<std::int64_t, 4> vertex;
  std::array<double, 4> weight;
};

Interpolation interpolate(const mesh::CubeMesh& coarse, const mesh::CubeMesh& fine,
                          const mesh::Lattice& v) {
  mesh::Lattice corner{};
  std::array<double, 3> fraction{};
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t scaled = v[axis] * coarse.cells;
    corner[axis] = std::min(scaled / fine.cells, coarse.cells - 1);
    fraction[axis] =
        static_cast<double>(scaled - corner[axis] * fine.cells) / static_cast<double>(fine.cells);
  }
  // The Kuhn tetrahedron of a point follows the axes in the order of falling coordinates.
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return fraction[a] > fraction[b]; });
  Interpolation result{};
  double left = 1;
  for (int i = 0; i < 3; ++i) {
    result.vertex[i] = coarse.vertex_id(corner);
    result.weight[i] = left - fraction[order[i]];
    left = fraction[order[i]];
    ++corner[order[i]];
  }
  result.vertex[3] = coarse.vertex_id(corner);
  result.weight[3] = left;
  return result;
}

// The threshold θ at which the nodes with u < θ carry `target` of the weight. The node on the
// threshold is filled partly, so that the target is met exactly.
struct Threshold {
  double below, at;  // u <= below: 1; below < u <= at: partly; above: 0
  double partial;
};

template <class WeightBelow>
Threshold find_threshold(double target, double total, const WeightBelow& weight_below) {
  double low = 0, high = 1;  // weight_below(low) <= target <= weight_below(high)
  if (!(target < total)) return {1, 1, 0};
  while (true) {
    const double middle = 0.5 * (low + high);
    if (!(middle > low && middle < high)) break;
    (weight_below(middle) <= target ? low : high) = middle;
  }
  const double inside = weight_below(low), beyond = weight_below(high);
  return {low, high, beyond > inside ? (target - inside) / (beyond - inside) : 0};
}

Vec bernoulli(const fem::SurfaceSpace& space, const InitialRequest& request) {
  const mesh::CubeMesh& fine = space.mesh.cube;
  const mesh::CubeMesh coarse{request.noise_cells > 0 ? request.noise_cells : fine.cells};
  struct Draw {
    double u, weight;
  };
  std::unordered_map<std::int64_t, std::size_t> index;  // draws in order of first appearance
  std::vector<Draw> draws;
  std::vector<Interpolation> rows;
  for (int i = 0; i < space.nodes(); ++i) {
    rows.push_back(interpolate(coarse, fine, fine.vertex(space.mesh.node_id[i])));
    for (int k = 0; k < 4; ++k) {
      if (rows.back().weight[k] == 0) continue;
      const std::int64_t vertex = rows.back().vertex[k];
      const auto [entry, added] = index.try_emplace(vertex, draws.size());
      if (added)
        draws.push_back(
            {uniform_random(request.seed, kBernoulliStream, static_cast<std::uint64_t>(vertex)),
             0});
      draws[entry->second].weight += rows.back().weight[k] * space.node_area[i];
    }
  }
  const Threshold threshold =
      find_threshold(request.raft_fraction * space.area, space.area, [&](double theta) {
        double sum = 0;
        for (const Draw& draw : draws)
          if (draw.u <= theta) sum += draw.weight;
        return space.communicator->sum(sum);
      });
  Vec c(space.nodes());
  for (int i = 0; i < space.nodes(); ++i) {
    double value = 0;
    for (int k = 0; k < 4; ++k) {
      if (rows[i].weight[k] == 0) continue;
      const double u = draws[index.at(rows[i].vertex[k])].u;
      const double raft = u <= threshold.below ? 1 : u <= threshold.at ? threshold.partial : 0;
      value += rows[i].weight[k] * raft;
    }
    c[i] = request.well.a + (request.well.b - request.well.a) * value;
  }
  return c;
}

// Σ cos(k·x + φ) with wave vectors of random direction and a length within 20 % of 2π/wavelength:
// the same field on every mesh.
Vec band_limited(const fem::SurfaceSpace& space, const InitialRequest& request,
                 const Parameters& parameters) {
  constexpr int kWaves = 64;
  struct Wave {
    Point k;
    double phase;
  };
  std::vector<Wave> waves;
  for (int w = 0; w < kWaves; ++w) {
    const auto draw = [&](int which) {
      return uniform_random(request.seed, kWaveStream, static_cast<std::uint64_t>(4 * w + which));
    };
    const double z = 2 * draw(0) - 1, around = 2 * kPi * draw(1), r = std::sqrt(1 - z * z);
    const double length = 2 * kPi / parameters["wavelength"] * (0.8 + 0.4 * draw(2));
    waves.push_back(
        {length * Point(r * std::cos(around), r * std::sin(around), z), 2 * kPi * draw(3)});
  }
  Vec c(space.nodes());
  for (int i = 0; i < space.nodes(); ++i) {
    const Point x = space.mesh.position(i);
    double sum = 0;
    for (const Wave& wave : waves) sum += std::cos(wave.k.dot(x) + wave.phase);
    c[i] = parameters["amplitude"] * std::sqrt(2.0 / kWaves) * sum;
  }
  c.array() += request.raft_fraction - space.integral(c) / space.area;
  return request.well.a + (request.well.b - request.well.a) * c.array();
}

}  // namespace

InitialEntry bernoulli_noise() {
  return {"noise",
          "raft or not, at random at every node of the noise mesh",
          {},
          [](const fem::SurfaceSpace& space, const InitialRequest& request, const Parameters&) {
            return bernoulli(space, request);
          },
          {}};
}

InitialEntry band_limited_noise() {
  return {"band-limited",
          "smooth noise of one wavelength, the same on every mesh",
          {{"wavelength", "R", 0.3, 0.01, 10, "typical wavelength"},
           {"amplitude", "b-a", 0.05, 0, 1, "standard deviation"}},
          band_limited,
          {}};
}

}  // namespace traceraft::problem
