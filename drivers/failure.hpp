// Exceptions become an exit code and a line that says why.
#pragma once

#include <exception>
#include <string>

#include "drivers/exit_codes.hpp"

namespace traceraft::drivers {

struct Failure {
  ExitCode code;
  std::string why;
};

Failure failure_of(const std::exception_ptr& thrown);

}  // namespace traceraft::drivers
