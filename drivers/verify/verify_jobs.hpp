// Studies side by side, as processes of their own: small meshes leave processors idle.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "verification/studies/study.hpp"

namespace traceraft::verify {

struct StudyJobs {
  std::vector<studies::StudyEntry> studies;
  std::vector<std::string> flags;  // of `verify`, the same for all
  std::string measured_with;       // that is what these flags amount to
  int at_a_time;
  bool quiet;
};

// Leaves in `folder` what a verification there would leave of each study. False if it was asked to
// stop before that. Throws IoError if a process ends without a result.
bool carry_out_side_by_side(const StudyJobs& jobs, const std::filesystem::path& folder);

}  // namespace traceraft::verify
