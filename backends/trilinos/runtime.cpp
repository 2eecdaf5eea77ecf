#include "backends/trilinos/runtime.hpp"

#include <Tpetra_Core.hpp>

namespace traceraft::trilinos {

void start_trilinos() {
  if (Tpetra::isInitialized()) return;
  // It needs arguments, and looks for options of Kokkos among them.
  static char name[] = "traceraft";
  static char* arguments[] = {name, nullptr};
  static char** values = arguments;
  static int count = 1;
  Tpetra::initialize(&count, &values);
}

void finish_trilinos() {
  if (Tpetra::isInitialized()) Tpetra::finalize();
}

}  // namespace traceraft::trilinos
