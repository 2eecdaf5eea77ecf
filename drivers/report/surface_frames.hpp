// The fields that a run has written, as frames for pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernel/observables/surface_view.hpp"

namespace traceraft::report {

struct Frame {
  std::size_t mesh;  // number in a list
  Vec values;        // at its points
};

struct SurfaceFrames {
  std::vector<observables::SurfaceMesh> meshes;  // one, or those that a run has had
  std::vector<double> times;                     // in the units of the run's files
  std::vector<Frame> frames;                     // of each time, the concentration
};

// Corners of Γ_h nearer to each other than `detail` (a share of the surface's size) become one: cut
// cells have triangles of all sizes, and pictures need no more. At most `most` frames, evenly
// chosen, the first and the last among them. Throws InputError if the run has written no fields,
// IoError if they are damaged.
SurfaceFrames read_frames(const std::filesystem::path& run_folder, double detail, int most);

}  // namespace traceraft::report
