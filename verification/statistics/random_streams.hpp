// All random numbers outside of the kernel: every draw names its stream or its seed here.
#pragma once

#include <cstdint>

namespace traceraft::statistics {

// Streams of a seed that a user gives or a campaign makes.
namespace stream {
enum : std::uint64_t {
  second_effect = 1,    // which effect a case of a campaign hides beside the first
  diffusion = 2,        // D of the truth of such a case
  hidden_effect = 3,    // of `hide`
  drawn_vesicles = 17,  // from published facts
  bootstrap = 91,
  placement = 101,  // of the truth of a blind case in its mesh
  snapshot_times = 102,
  hidden_strength = 103,
  points = 300,  // and two more for each snapshot
  noise = 500,   // and one more for each snapshot, as below
  shared_noise = 700
};
}  // namespace stream

// Streams of the number of a data set that a model of vesicles gives.
namespace replicate_stream {
enum : std::uint64_t {
  run = 1,
  vesicle = 2,
  observation = 3,
  stated_error = 5,
  known_unit = 6,
  other_runs = 32,
  search_start = 33
};
}  // namespace replicate_stream

// Streams of the number of a position of a surface in its mesh.
namespace position_stream {
enum : std::uint64_t { motion = 71 };
}  // namespace position_stream

// Seeds of what is drawn alike whoever asks.
namespace fixed_seed {
enum : std::uint64_t {
  test_vectors = 1,
  field_errors = 2,
  replicate_values = 7,
  replicate_model_errors = 8,
  replicate_diffusion = 9,
  replicate_frames = 10,
  kriging_rows = 11,
  kriging_noise = 12,
  field_draws = 13,
  registration = 14,
  replicate_noise_size = 16,
  replicate_random_effects = 17
};
}  // namespace fixed_seed

}  // namespace traceraft::statistics
