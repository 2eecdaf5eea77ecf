// Trilinos (and MPI, if nobody has yet) started before its first use and ended in good order.
#pragma once

namespace traceraft::trilinos {

// Does nothing if it has been called before.
void start_trilinos();
// After the last object of Trilinos is gone, before MPI ends. Does nothing if it was never started.
void finish_trilinos();

}  // namespace traceraft::trilinos
