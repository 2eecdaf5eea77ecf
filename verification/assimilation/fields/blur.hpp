// The effect of a microscope's blur on a field: heat that flows along the surface until its kernel
// is as wide.
#pragma once

#include <memory>

#include "kernel/fem/surface_space.hpp"

namespace traceraft::assimilation {

class Blur {
 public:
  // `width`: standard deviation of the point spread function, in the unit of the space; short
  // against the radii of curvature. Serial spaces. Throws std::runtime_error if the width is no
  // number.
  Blur(const fem::SurfaceSpace& space, double width);
  ~Blur();

  Vec blurred(const Vec& c) const;

 private:
  struct Step;
  std::unique_ptr<const Step> step_;
};

}  // namespace traceraft::assimilation
