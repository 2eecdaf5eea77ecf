#include "verification/assimilation/forecast/curvature_contrast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/geometry/differences.hpp"

namespace traceraft::assimilation {
double curvature_contrast(const geometry::LevelSet& surface, const std::vector<Point>& places) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const Point& x : places) {
    const double H = 0.5 * geometry::LevelSetDerivatives(surface, x).div_normal();
    least = std::min(least, H);
    most = std::max(most, H);
  }
  return (most - least) / std::max(std::fabs(least), std::fabs(most));
}

}  // namespace traceraft::assimilation
