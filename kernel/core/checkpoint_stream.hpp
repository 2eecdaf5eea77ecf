// Where the state of a run is written to and read from, whatever number of ranks it is spread over.
#pragma once

#include <functional>
#include <istream>
#include <ostream>
#include <vector>

#include "kernel/core/binary.hpp"
#include "kernel/core/global_order.hpp"

namespace traceraft {

// Numbers are the same on all ranks, and the first one writes them. State vectors, two fields of
// the order each, are gathered: what is written does not depend on the number of ranks.
struct CheckpointOut {
  CheckpointOut(std::ostream& stream_) : stream(stream_) {}  // of one process
  CheckpointOut(std::ostream& stream_, const GlobalOrder& order_)
      : stream(stream_), order(&order_) {}

  std::ostream& stream;  // used by the first rank
  const GlobalOrder* order = nullptr;
};

// State vectors that were written on another mesh, and what they are on the present one. Carrying
// is affine: a difference of states becomes the difference of what they become.
struct CarriedStates {
  Eigen::Index length;  // of those that were written
  std::function<Vec(VecView)> state, difference;
};

struct CheckpointIn {
  CheckpointIn(std::istream& stream_) : stream(stream_) {}
  CheckpointIn(std::istream& stream_, const GlobalOrder& order_)
      : stream(stream_), order(&order_) {}
  CheckpointIn(std::istream& stream_, const CarriedStates& carried_)  // of one process
      : stream(stream_), carried(&carried_) {}

  bool distributed() const { return order && order->ranks().size() > 1; }

  std::istream& stream;
  const GlobalOrder* order = nullptr;
  const CarriedStates* carried = nullptr;
};

template <class T>
void write_binary(CheckpointOut out, const T& value) {
  if (!out.order || out.order->ranks().root()) write_binary(out.stream, value);
}

inline void write_binary(CheckpointOut out, const Vec& state) {
  if (!out.order) return write_binary(out.stream, state);
  const Eigen::Index n = state.size() / 2;
  const Vec first = out.order->gathered(state.head(n)), second = out.order->gathered(state.tail(n));
  Vec whole(first.size() + second.size());
  whole << first, second;
  if (out.order->ranks().root()) write_binary(out.stream, whole);
}

// Throws IoError on the first rank if the data end too early.
template <class T>
void read_binary(CheckpointIn in, T& value) {
  if (!in.distributed()) return read_binary(in.stream, value);
  struct Box {
    T value;
  };
  const Communicator& ranks = in.order->ranks();
  Lists<Box> values;
  if (ranks.root()) {
    read_binary(in.stream, value);
    values.assign(static_cast<std::size_t>(ranks.size()), std::vector<Box>(1, Box{value}));
  }
  value = scatter(ranks, values)[0].value;
}

// A state vector. `expected`: the length on this rank.
inline void read_binary(CheckpointIn in, Vec& state, Eigen::Index expected) {
  if (in.carried) {
    Vec written;
    read_binary(in.stream, written, in.carried->length);
    state = in.carried->state(written);
    return;
  }
  if (!in.distributed()) return read_binary(in.stream, state, expected);
  const Eigen::Index n = in.order->size();
  Vec whole;
  if (in.order->ranks().root()) read_binary(in.stream, whole, 2 * n);
  const bool root = in.order->ranks().root();
  state.resize(expected);
  state << in.order->scattered(whole.head(root ? n : 0)),
      in.order->scattered(whole.tail(root ? n : 0));
}

// A difference of state vectors, or a rate.
inline void read_difference(CheckpointIn in, Vec& difference, Eigen::Index expected) {
  if (!in.carried) return read_binary(in, difference, expected);
  Vec written;
  read_binary(in.stream, written, in.carried->length);
  difference = in.carried->difference(written);
}

}  // namespace traceraft
