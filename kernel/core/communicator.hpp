// How a rank talks to the others. The kernel knows only this interface; backends/mpi will
// implement it, and a serial run uses SerialCommunicator, whose calls cost nothing.
#pragma once

#include <vector>

#include "kernel/core/types.hpp"

namespace traceraft {

// Which entries of a local field travel where. Local fields hold the owned entries first, then
// the ghosts grouped by neighbour in the order of `neighbours`.
struct HaloPlan {
  struct Neighbour {
    int rank;
    std::vector<int> send;  // owned entries that this neighbour holds as ghosts
    int receive_count;
  };
  std::vector<Neighbour> neighbours;
};

class Communicator {
 public:
  virtual ~Communicator() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  virtual double sum(double local) const = 0;
  virtual double max(double local) const = 0;
  virtual double min(double local) const = 0;
  // Fills the ghost entries of `field` (owned entries first) from their owners.
  virtual void update_ghosts(const HaloPlan& plan, VecRef field) const = 0;
};

class SerialCommunicator final : public Communicator {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  double sum(double local) const override { return local; }
  double max(double local) const override { return local; }
  double min(double local) const override { return local; }
  void update_ghosts(const HaloPlan&, VecRef) const override {}
};

}  // namespace traceraft
