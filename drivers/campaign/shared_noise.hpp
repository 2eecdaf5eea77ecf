// The correlated part of the noise of drawn measurements.
#pragma once

#include <string>
#include <vector>

#include "verification/selection/blind/blind_request.hpp"

namespace traceraft::campaign {

inline constexpr double kShortestDrawn = 0.005, kLongestDrawn = 0.5;  // in R

struct SharedNoise {
  double length = 0;  // in R
  double share = 0;   // of the variance
  std::string shape = "gaussian";
};

const std::vector<std::string>& shared_noise_shapes();

// Throws InputError for a share without a length, or another shape.
void check_shared_noise(const SharedNoise& noise);
void set_shared_noise(const SharedNoise& noise, selection::BlindRequest& request);

}  // namespace traceraft::campaign
