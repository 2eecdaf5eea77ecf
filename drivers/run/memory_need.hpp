// Does a mesh fit into the memory of this machine?
#pragma once

#include <string>

#include "drivers/config/configuration.hpp"
#include "kernel/core/communicator.hpp"
#include "kernel/geometry/level_set.hpp"

namespace traceraft::run {

// The number of nodes, judged by a coarse mesh. It is 0 for meshes that are made at once, and where
// the coarse one cannot be made.
double nodes_of_fine_mesh(const geometry::LevelSet& surface, std::int64_t cells);

// The least memory that the set-up of a run takes on each rank, in bytes, or 0 where that number
// is 0: such meshes fit anywhere.
double least_memory(const geometry::LevelSet& surface, std::int64_t cells, int ranks);

// A complaint about cells that need more bytes than there are; "" if they fit.
std::string memory_complaint(std::int64_t cells, double need, double there_is);

// Throws InputError, before hours or all memory are spent, if that is more than the machine has.
void refuse_too_fine(const config::Configuration& configuration, const geometry::LevelSet& surface,
                     const Communicator& ranks);

}  // namespace traceraft::run
