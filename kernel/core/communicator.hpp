// How a rank talks to the others. The kernel knows only this interface; backends/mpi implements it,
// and a run of one process uses SerialCommunicator, whose calls cost nothing.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "kernel/core/types.hpp"

namespace traceraft {

// The entries of a local field that travel, and where to. Local fields hold the owned entries
// first, then the ghosts grouped by neighbour in the order of `neighbours`.
struct HaloPlan {
  struct Neighbour {
    int rank;
    std::vector<int> send;  // owned entries that this neighbour holds as ghosts
    int receive_count;
  };
  std::vector<Neighbour> neighbours;  // ascending in rank
};

// Every function is collective: all ranks call the same ones in the same order; only update_ghosts
// concerns a rank and its neighbours alone, and a rank without any may leave it out. Results of
// reductions are bitwise the same on all ranks, so that ranks decide alike.
class Communicator {
 public:
  virtual ~Communicator() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  virtual double sum(double local) const = 0;
  virtual double max(double local) const = 0;
  virtual double min(double local) const = 0;
  // The largest of each entry over the ranks.
  virtual void max(VecRef values) const = 0;
  // Fills the ghost entries of `field` (owned entries first) from their owners.
  virtual void update_ghosts(const HaloPlan& plan, VecRef field) const = 0;
  // Sends to[r] to rank r, and returns what each rank sent here.
  virtual std::vector<std::string> exchange(std::vector<std::string> to) const = 0;

  bool root() const { return rank() == 0; }
  // Does it hold on every rank?
  bool all(bool local) const { return min(local ? 1.0 : 0.0) > 0; }
  bool any(bool local) const { return max(local ? 1.0 : 0.0) > 0; }
};

class SerialCommunicator final : public Communicator {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  double sum(double local) const override { return local; }
  double max(double local) const override { return local; }
  double min(double local) const override { return local; }
  void max(VecRef) const override {}
  void update_ghosts(const HaloPlan&, VecRef) const override {}
  std::vector<std::string> exchange(std::vector<std::string> to) const override { return to; }
};

// One process, for functions that need no other.
inline const SerialCommunicator kAlone;

// Lists of plain values instead of bytes.
template <class T>
using Lists = std::vector<std::vector<T>>;

template <class T>
std::string to_bytes(const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}
template <class T>
std::vector<T> from_bytes(const std::string& bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

// Sends to[r] to rank r; the result holds what each rank sent.
template <class T>
Lists<T> exchange_lists(const Communicator& ranks, const Lists<T>& to) {
  std::vector<std::string> bytes;
  for (const std::vector<T>& list : to) bytes.push_back(to_bytes(list));
  Lists<T> received;
  for (const std::string& message : ranks.exchange(std::move(bytes)))
    received.push_back(from_bytes<T>(message));
  return received;
}

// The values of every rank, on the first one; empty on the others.
template <class T>
Lists<T> gather(const Communicator& ranks, const std::vector<T>& values) {
  Lists<T> to(static_cast<std::size_t>(ranks.size()));
  to[0] = values;
  Lists<T> all = exchange_lists(ranks, to);
  return ranks.root() ? all : Lists<T>{};
}

// The values of every rank, everywhere.
template <class T>
Lists<T> gather_everywhere(const Communicator& ranks, const std::vector<T>& values) {
  return exchange_lists(ranks, Lists<T>(static_cast<std::size_t>(ranks.size()), values));
}

// lists[r] of the first rank, on rank r.
template <class T>
std::vector<T> scatter(const Communicator& ranks, const Lists<T>& lists) {
  Lists<T> to(static_cast<std::size_t>(ranks.size()));
  return exchange_lists(ranks, ranks.root() ? lists : to)[0];
}

}  // namespace traceraft
