// docs/exit-codes.md explains them.
#pragma once

#include <exception>
#include <string>

namespace traceraft::drivers {

enum ExitCode : int {
  kSuccess = 0,
  kClaimFailed = 1,
  kBadInput = 2,
  kNumericalFailure = 3,
  kInputOutput = 4,
  kInterrupted = 5,
  kLocked = 6,
  kInternalError = 70
};

// Exceptions become an exit code and a line that says why.
struct Failure {
  ExitCode code;
  std::string why;
};
Failure failure_of(const std::exception_ptr& thrown);

}  // namespace traceraft::drivers
