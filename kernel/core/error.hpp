// What went wrong outside the numerics. Each class has one exit code (docs/exit-codes.md).
#pragma once

#include <stdexcept>

namespace traceraft {

// The user asked for something impossible: one line naming what, where and what would be valid.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A file could not be written, read or trusted.
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace traceraft
