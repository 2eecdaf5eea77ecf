// The end of another run as the beginning of this one.
#pragma once

#include <filesystem>

#include "drivers/config/configuration.hpp"
#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft::run {

// c in the newest checkpoint of a run folder, at the nodes of this rank. On another mesh than that
// run ended on, it is carried over as in a remesh, with the μ that `model` gives there. Throws
// InputError if there is no checkpoint, no field in it, or another surface.
Vec earlier_field(const std::filesystem::path& run_folder,
                  const config::Configuration& configuration,
                  const problem::CahnHilliardModel& model, const fem::SurfaceSpace& space);

}  // namespace traceraft::run
