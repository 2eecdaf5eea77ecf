// Numerical failures of commands that cannot do without the result: exit code 3.
#pragma once

#include <filesystem>
#include <stdexcept>

#include "kernel/core/error.hpp"

namespace traceraft::drivers {

struct NumericalFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Does it; what it throws is a numerical failure unless it is about input or files.
template <class Work>
auto numerically(const Work& work) {
  try {
    return work();
  } catch (const InputError&) {
    throw;
  } catch (const IoError&) {
    throw;
  } catch (const std::filesystem::filesystem_error&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw NumericalFailure(error.what());
  }
}

}  // namespace traceraft::drivers
