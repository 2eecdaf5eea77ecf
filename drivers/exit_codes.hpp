// docs/exit-codes.md explains them.
#pragma once

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

}  // namespace traceraft::drivers
