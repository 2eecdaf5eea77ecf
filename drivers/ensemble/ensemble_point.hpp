// One model from several seeds, as a step of something larger.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "drivers/ensemble/ensemble_runs.hpp"

namespace traceraft::ensemble {

// All that decides what a run of the model computes, but the seed, and until t_end (s), with no
// output before.
config::GivenValues settings_until(const config::Configuration& model, double t_end);

// Throws InputError unless the initial state is one of these, in which runs of several seeds
// differ.
void refuse_initial_state_but(const config::Configuration& model,
                              const std::vector<std::string>& random);
// The same for simulated vesicles.
void refuse_without_noise(const config::Configuration& model);

struct PointRequest {
  int runs, jobs;
  bool quiet;
  int threads = 0;  // of each run; 0: what the jobs leave
};
struct PointEnd {
  bool stopped = false;
  std::vector<MemberFailure> failures;
  std::vector<observations::History> runs;  // in units of R²/D
  std::vector<std::uint64_t> seeds;         // theirs
};
// Carries out, or goes on with, the ensemble in the folder.
PointEnd run_point(const std::filesystem::path& folder, const config::Configuration& configuration,
                   const PointRequest& request);

// Where runs are compared one by one: leaves those whose seeds have finished at all points.
void keep_common_seeds(std::vector<PointEnd>& ends);

}  // namespace traceraft::ensemble
