// Errors outside the numerics. Each class has one exit code (docs/exit-codes.md).
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace traceraft {

// The user asked for something impossible: one line naming what, where and what would be valid.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The same of one of several options that a part of the program was given; who knows their flags
// puts that in front.
struct OptionError : InputError {
  OptionError(std::string option_, const std::string& why)
      : InputError(why), option(std::move(option_)) {}
  std::string option;
};

// A file could not be written, read or trusted.
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// It was read, and its content is not what it has to be.
struct DamagedFile : IoError {
  using IoError::IoError;
};

}  // namespace traceraft
