#include "kernel/flow/spherical_harmonics.hpp"

#include <cmath>

namespace traceraft::flow {

Vec legendre(int degree, int m, double x) {
  const double sine = std::sqrt(std::fmax(0.0, (1 - x) * (1 + x)));
  double diagonal = std::sqrt(0.5);  // P̃_mm = √((2m + 1)/(2m)) sin θ P̃_(m-1)(m-1)
  for (int k = 1; k <= m; ++k) diagonal *= std::sqrt((2 * k + 1) / (2.0 * k)) * sine;
  Vec value(degree - m + 1);
  value[0] = diagonal;
  if (degree > m) value[1] = std::sqrt(2 * m + 3.0) * x * diagonal;
  for (int l = m + 2; l <= degree; ++l) {
    const double factor = std::sqrt((4.0 * l * l - 1) / (static_cast<double>(l) * l - m * m));
    const double before = std::sqrt(((l - 1.0) * (l - 1) - m * m) / (4.0 * (l - 1) * (l - 1) - 1));
    value[l - m] = factor * (x * value[l - m - 1] - before * value[l - m - 2]);
  }
  return value;
}

}  // namespace traceraft::flow
