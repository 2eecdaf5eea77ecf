// The last accepted states of a run, for interpolation between them.
#pragma once

#include <cstddef>
#include <deque>

#include "kernel/core/checkpoint_stream.hpp"
#include "kernel/core/types.hpp"

namespace traceraft::time {

// Keeps the newest states, at most `most`, with their times.
class StateHistory {
 public:
  explicit StateHistory(std::size_t most) : most_(most) {}

  void clear() { entries_.clear(); }
  void add(double t, Vec y);
  std::size_t size() const { return entries_.size(); }
  // 0: the newest
  double time(std::size_t back) const { return entries_[entries_.size() - 1 - back].t; }
  const Vec& state(std::size_t back) const { return entries_[entries_.size() - 1 - back].y; }
  Vec& newest() { return entries_.back().y; }

  // The polynomial through all kept states. Its weights sum to one, so every linear functional that
  // the states share (the mass) is kept. Exactly a state at its time.
  void interpolate(double t, VecRef y) const;

  void save(CheckpointOut out) const;
  void load(CheckpointIn in, Eigen::Index length);  // throws IoError

 private:
  struct Entry {
    double t;
    Vec y;
  };
  std::size_t most_;
  std::deque<Entry> entries_;  // oldest first
};

}  // namespace traceraft::time
