// The choices of --linear-solver teko: its options, and the user's file of Teuchos parameter lists.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <cstddef>
#include <exception>
#include <string>

#include "backends/trilinos/teko_solver.hpp"

namespace traceraft::trilinos {

struct TekoParameters {
  std::string preconditioner, inverse, method;
  bool always_new = false;  // a preconditioner for every Jacobian
  // The user's file and its lists; "" and empty ones if there is none.
  std::string file;
  Teuchos::ParameterList inverses, belos;
  std::size_t checksum = 0;
};

// Throws OptionError for a name or a file that is not known.
TekoParameters read_teko_parameters(const TekoOptions& options, int ranks);

// Throws OptionError: Trilinos did not take what is in the file.
[[noreturn]] void refuse_lists(const TekoParameters& parameters, const std::exception& error);

// Runs `make`; what Trilinos does not know of a user's lists is the file's fault.
template <class Make>
auto said_of_lists(const TekoParameters& parameters, const Make& make) {
  try {
    return make();
  } catch (const std::exception& error) {
    if (parameters.file.empty()) throw;
    refuse_lists(parameters, error);
  }
}

}  // namespace traceraft::trilinos
