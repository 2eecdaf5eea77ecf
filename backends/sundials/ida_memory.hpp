// The state of a running IDA, for checkpoints that do not disturb the run.
#pragma once

#include "kernel/core/checkpoint_stream.hpp"

namespace traceraft::sundials {

// Everything that the next step depends on: divided differences, orders, step sizes, the
// convergence rate of Newton's method, counters. `memory` comes from IDACreate.
//
// IDA's public interface can only start anew at order 1 with a small step, so that a checkpoint
// would either bend the run that writes it or lose bitwise resumption. Its memory, whose layout is
// part of the package (ida/ida_impl.h), holds all there is to save. See docs/decisions.
void save_ida_memory(void* memory, CheckpointOut out);

// Into a memory that IDAInit, the linear solver and all options have been applied to, and that has
// not taken a step. Throws IoError if the data are not of this size and version.
void load_ida_memory(void* memory, CheckpointIn in);

}  // namespace traceraft::sundials
