// A picture of a field on Γ_h: front and back of the surface side by side.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/fem/surface_space.hpp"

namespace traceraft::observables {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from the top, three bytes a pixel
};

// The dark grey of letters and lines.
inline constexpr std::array<std::uint8_t, 3> kInk = {40, 40, 40};

// Colours a rectangle of pixels, as far as it lies in the image.
void fill(Image& image, int left, int top, int width, int height,
          const std::array<std::uint8_t, 3>& colour);

// Triangles, counter-clockwise seen from outside, and their corners.
struct SurfaceMesh {
  std::vector<Point> position;
  std::vector<std::array<int, 3>> triangles;
};

// Parallel projection of the surface coloured by `values` (one per point of Γ_h), dark at `low` and
// bright at `high`, on white. `size`: pixels per edge of each of the two squares. Collective; every
// rank gets the whole picture.
Image draw_front_and_back(const fem::SurfaceSpace& space, const Vec& values, double low,
                          double high, int size);

// Half of what each of the two squares shows, in units of R. Collective.
double view_half_width(const fem::SurfaceSpace& space);
// The colour of a surface that is lit from the front; share: 0 for `low`, 1 for `high`.
std::array<std::uint8_t, 3> surface_colour(double share);

Image draw_front_and_back(const SurfaceMesh& mesh, const Vec& values, double low, double high,
                          int size);

}  // namespace traceraft::observables
