// Quadrature on a triangle, exact for polynomials of degree 4: six points (Dunavant 1985).
#pragma once

#include <array>

namespace traceraft::fem {

struct TrianglePoint {
  std::array<double, 3> at;  // barycentric coordinates
  double weight;             // sums to one
};

inline constexpr std::array<TrianglePoint, 6> kDegreeFourRule = [] {
  constexpr double a = 0.445948490915965, wa = 0.223381589678011;
  constexpr double b = 0.091576213509771, wb = 0.109951743655322;
  return std::array<TrianglePoint, 6>{{{{{1 - 2 * a, a, a}}, wa},
                                       {{{a, 1 - 2 * a, a}}, wa},
                                       {{{a, a, 1 - 2 * a}}, wa},
                                       {{{1 - 2 * b, b, b}}, wb},
                                       {{{b, 1 - 2 * b, b}}, wb},
                                       {{{b, b, 1 - 2 * b}}, wb}}};
}();

// The value at a point of the rule of a function that is linear on a triangle.
inline double between_corners(const std::array<double, 3>& corner,
                              const std::array<double, 3>& at) {
  return at[0] * corner[0] + at[1] * corner[1] + at[2] * corner[2];
}

}  // namespace traceraft::fem
