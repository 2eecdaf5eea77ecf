// The kernel's communicator on MPI.
#pragma once

#include <memory>

#include "kernel/core/communicator.hpp"

namespace traceraft {

// MPI from its start to its end. One object per process, made before and destroyed after all that
// uses MPI.
class MpiSession {
 public:
  MpiSession();  // throws std::runtime_error if MPI does not start
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  // All processes that were started together.
  std::shared_ptr<const Communicator> world() const;

  // For a process that fails: true if all others come here, too, within the seconds given, so that
  // every process can end in good order.
  bool all_fail(double seconds) const;
  // Ends all processes at once.
  [[noreturn]] void abort(int exit_code) const;
};

}  // namespace traceraft
