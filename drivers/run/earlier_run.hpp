// The end of another run as the beginning of this one.
#pragma once

#include <filesystem>

#include "drivers/config/configuration.hpp"
#include "drivers/run/checkpoint_store.hpp"
#include "kernel/problem/cahn_hilliard.hpp"

namespace traceraft::run {

// The newest checkpoint of a run folder, which is read once, as a field on any mesh.
class EarlierRun {
 public:
  // Throws InputError if there is no checkpoint, no field in it, or another surface.
  EarlierRun(const std::filesystem::path& run_folder, const config::Configuration& configuration,
             const problem::CahnHilliardModel& model);

  // c at the nodes of this rank. On another mesh than that run ended on, it is carried over as in a
  // remesh, with the μ that the model gives there.
  Vec field_on(const fem::SurfaceSpace& space);

 private:
  const std::filesystem::path folder_;
  const problem::CahnHilliardModel model_;
  Checkpoint checkpoint_;
  config::Configuration theirs_;
  std::shared_ptr<const fem::SurfaceSpace> from_;  // that run's, as a whole on each rank
  Vec c_, state_;                                  // on it; (c, μ) once it is asked for
};

}  // namespace traceraft::run
