// Animations as GIF files (giflib).
#pragma once

#include <string>
#include <vector>

#include "kernel/observables/surface_view.hpp"

namespace traceraft::gif {

// The bytes of a GIF file that shows the images one after the other, each for `centiseconds`, again
// and again. All of one size. Throws std::runtime_error if giflib refuses.
std::string gif_bytes(const std::vector<observables::Image>& images, int centiseconds);

}  // namespace traceraft::gif
