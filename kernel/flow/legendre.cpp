#include "kernel/flow/legendre.hpp"

#include <cmath>

namespace traceraft::flow {

// The recurrence in l is stable. It begins with P̃_mm = √((2m + 1)/(2m)) sin θ P̃_(m-1)(m-1).
Vec legendre(int degree, int m, double theta) {
  const double x = std::cos(theta), sine = std::sqrt(std::fmax(0.0, (1 - x) * (1 + x)));
  double diagonal = std::sqrt(0.5);
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

// sin θ dP̃_l/dθ = l cos θ P̃_l − √((2l + 1)(l² − m²)/(2l − 1)) P̃_(l-1)
Vec legendre_slopes(int degree, int m, double theta) {
  const Vec value = legendre(degree, m, theta);
  Vec slope(value.size());
  for (int l = m; l <= degree; ++l) {
    const double before =
        l == m ? 0
               : std::sqrt((2.0 * l + 1) * (static_cast<double>(l) * l - m * m) / (2 * l - 1)) *
                     value[l - m - 1];
    slope[l - m] = (l * std::cos(theta) * value[l - m] - before) / std::sin(theta);
  }
  return slope;
}

Vec means_over_cap(double cosine, int degree) {
  Vec result(degree + 1);
  result[0] = 0;
  double before = 1, value = cosine, slope = 1;  // P_(l-1), P_l and P_l'
  for (int l = 1; l <= degree; ++l) {
    result[l] = 2 * slope / (l * (l + 1.0));
    slope = (l + 1) * value + cosine * slope;
    const double next = ((2 * l + 1) * cosine * value - l * before) / (l + 1);
    before = value;
    value = next;
  }
  return result;
}

}  // namespace traceraft::flow
