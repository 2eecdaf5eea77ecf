// A vesicle of discs in time: they ripen, wander and merge.
#pragma once

#include <cstdint>
#include <istream>
#include <ostream>
#include <vector>

#include "kernel/core/status.hpp"
#include "kernel/discs/brownian_motion.hpp"
#include "kernel/discs/random_discs.hpp"
#include "kernel/discs/ripening.hpp"

namespace traceraft::discs {

struct DiscState {
  double t = 0;
  std::vector<Disc> discs;
  double mass = 0;  // ∫ c
};

// Discs of local equilibrium that hold what those with straight profiles would.
DiscState start_state(const DiscModel& model, const StartingDiscs& start);

struct DiscStatistics {
  std::int64_t steps = 0, rejected = 0, walks = 0, merged = 0, dissolved = 0;
};

// Steps are made in A^(7/4) of each area A. A disc that dissolves loses area like a power of A
// between −½ (a constant mobility) and −1 (the degenerate one), so that this falls in a straight
// line nearly.
struct DiscCoordinates {
  Vec power;
  double mass = 0;
};

// A step is one of ripening (Bogacki and Shampine, order 3, with an error estimate). Discs walk
// once in a while, as far as they would have wandered since they walked last, which is short
// against the distances of neighbours. Two discs that touch become one, which keeps the mass: at
// the end of a step, or on a walk, with the probability that a Brownian path between both its ends
// has touched. They walk at the end that a step is given, too: what is shown then is where they
// are. Draws depend on the seed and the number of the walk.
class DiscSystem {
 public:
  // `tolerance`: of the error of a disc's area in a step, relative to it. Discs that touch merge at
  // once, and those that are too small dissolve.
  DiscSystem(const DiscModel& model, double tolerance, DiscState start);

  const DiscModel& model() const { return model_; }
  const Phases& phases() const { return ripening_.phases(); }
  const DiscState& state() const { return state_; }
  const DiscStatistics& statistics() const { return statistics_; }
  double step() const { return step_; }             // the last one
  double background(const DiscState& state) const;  // mean of c outside the discs
  // ∫ f0 + ½ ε² |∇c|²: that of the boundaries and of both phases.
  double energy(const DiscState& state) const;

  // One step, which does not pass t_end.
  Status advance(double t_end);

  // Everything that goes on. load: throws IoError at the end of the data.
  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  struct Attempt {
    Contents contents;
    DiscCoordinates rate;  // at the end
    double error;          // over the tolerance
  };

  void plan_walk();
  double longest_step() const;
  bool attempt(const Ripening& ripening, const DiscState& from, const DiscCoordinates& rate,
               double step, Attempt& result) const;
  bool walk(double time);
  bool touched_between(std::size_t i, std::size_t j, const std::vector<Disc>& start,
                       double time) const;
  void dissolve_small_discs();
  void merge(std::size_t kept, std::size_t gone);
  void merge_touching_discs();

  DiscModel model_;
  Ripening ripening_;
  BrownianMotion motion_;
  double tolerance_;
  DiscState state_;
  DiscCoordinates rate_;  // d/dt of the state; empty: not known
  double step_ = 0, next_step_ = 0;
  double last_walk_ = 0, next_walk_ = 0;  // times
  DiscStatistics statistics_;
};

}  // namespace traceraft::discs
