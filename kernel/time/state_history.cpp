#include "kernel/time/state_history.hpp"

#include <utility>

namespace traceraft::time {

void StateHistory::add(double t, Vec y) {
  entries_.push_back({t, std::move(y)});
  if (entries_.size() > most_) entries_.pop_front();
}

void StateHistory::interpolate(double t, VecRef y) const {
  y.setZero();
  for (const Entry& at : entries_) {
    double weight = 1;
    for (const Entry& other : entries_)
      if (other.t != at.t) weight *= (t - other.t) / (at.t - other.t);
    if (weight != 0) y += weight * at.y;
  }
}

void StateHistory::save(CheckpointOut out) const {
  write_binary(out, static_cast<std::uint64_t>(entries_.size()));
  for (const Entry& entry : entries_) {
    write_binary(out, entry.t);
    write_binary(out, entry.y);
  }
}

void StateHistory::load(CheckpointIn in, Eigen::Index length) {
  std::uint64_t size = 0;
  read_binary(in, size);
  if (size > most_) throw IoError("checkpoint: it holds too many states");
  entries_.clear();
  for (; size > 0; --size) {
    Entry entry{};
    read_binary(in, entry.t);
    read_binary(in, entry.y, length);
    entries_.push_back(std::move(entry));
  }
}

}  // namespace traceraft::time
