// The processes that this run is spread over: those that mpirun started, or this one alone.
#pragma once

#include <memory>

#include "kernel/core/communicator.hpp"

namespace traceraft::backends {

// From the start of the program to its end, around all that uses the ranks.
class RankSession {
 public:
  // Throws InputError if the program was started as several processes but built without MPI, or
  // with another one than that of the mpirun.
  RankSession();
  ~RankSession();
  RankSession(const RankSession&) = delete;
  RankSession& operator=(const RankSession&) = delete;

  // Was the program started by mpirun or its like, on however many ranks?
  static bool there_is();
  // For a rank that fails: true if all do, so that one of them may speak for them. If not, the
  // others wait for this one in vain: abort.
  static bool all_fail();
  [[noreturn]] static void abort(int exit_code);
};

// All of them; one process if there is no session.
std::shared_ptr<const Communicator> world();

}  // namespace traceraft::backends
