// The kernel's communicator on MPI.
#pragma once

#include <memory>

#include "kernel/core/communicator.hpp"

namespace traceraft::mpi {

// MPI counts bytes with int.
inline constexpr std::size_t kLongestMessage = std::size_t{1} << 30;

// All processes that were started together; a session must exist. Longer messages go in pieces.
std::shared_ptr<const Communicator> mpi_world(std::size_t longest_message = kLongestMessage);

// MPI from its start to its end. One object per process, made before and destroyed after all that
// uses MPI.
class MpiSession {
 public:
  MpiSession();  // throws std::runtime_error if MPI does not start
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  // For a process that fails: true if all others come here, too, within the seconds given, so that
  // every process can end in good order.
  bool all_fail(double seconds) const;
  // Ends all processes at once.
  [[noreturn]] void abort(int exit_code) const;
};

}  // namespace traceraft::mpi
