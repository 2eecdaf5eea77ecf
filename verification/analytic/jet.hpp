// Numbers that carry their first and second derivatives in space. T may be a jet again: two of them
// give derivatives up to the fourth order.
#pragma once

#include <array>
#include <cmath>

namespace traceraft::analytic {

template <class T>
struct Jet;
template <class T>
Jet<T> compose(const Jet<T>& a, const T& f, const T& df, const T& ddf);
inline double inverse(double a) {
  return 1 / a;
}

template <class T>
struct Jet {
  T value{};
  std::array<T, 3> gradient{};
  std::array<T, 6> hessian{};  // xx, xy, xz, yy, yz, zz

  Jet() = default;
  Jet(double constant) : value(constant) {}  // NOLINT: constants mix freely with jets

  Jet& operator+=(const Jet& b) {
    value += b.value;
    for (int i = 0; i < 3; ++i) gradient[i] += b.gradient[i];
    for (int i = 0; i < 6; ++i) hessian[i] += b.hessian[i];
    return *this;
  }
  friend Jet operator+(Jet a, const Jet& b) { return a += b; }
  friend Jet operator-(const Jet& a) { return compose(a, -a.value, T(-1.0), T(0.0)); }
  friend Jet operator-(const Jet& a, const Jet& b) { return a + -b; }
  friend Jet operator*(const Jet& a, const Jet& b) {
    Jet result;
    result.value = a.value * b.value;
    for (int i = 0; i < 3; ++i)
      result.gradient[i] = a.value * b.gradient[i] + a.gradient[i] * b.value;
    for (int k = 0; k < 6; ++k) {
      const int i = kRow[k], j = kColumn[k];
      result.hessian[k] = a.value * b.hessian[k] + a.hessian[k] * b.value +
                          a.gradient[i] * b.gradient[j] + a.gradient[j] * b.gradient[i];
    }
    return result;
  }
  T second(int i, int j) const { return hessian[kHessianIndex[i][j]]; }

  static constexpr int kHessianIndex[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  static constexpr int kRow[6] = {0, 0, 0, 1, 1, 2}, kColumn[6] = {0, 1, 2, 1, 2, 2};
};

// f(a), given f, f' and f'' at a.value.
template <class T>
Jet<T> compose(const Jet<T>& a, const T& f, const T& df, const T& ddf) {
  Jet<T> result;
  result.value = f;
  for (int i = 0; i < 3; ++i) result.gradient[i] = df * a.gradient[i];
  for (int k = 0; k < 6; ++k)
    result.hessian[k] =
        df * a.hessian[k] + ddf * a.gradient[Jet<T>::kRow[k]] * a.gradient[Jet<T>::kColumn[k]];
  return result;
}

template <class T>
Jet<T> inverse(const Jet<T>& a) {
  const T f = inverse(a.value), ff = f * f;
  return compose(a, f, -ff, T(2.0) * ff * f);
}
template <class T>
Jet<T> sqrt(const Jet<T>& a) {
  using std::sqrt;
  const T f = sqrt(a.value), df = T(0.5) * inverse(f);
  return compose(a, f, df, -(T(0.5) * df * inverse(a.value)));
}
}  // namespace traceraft::analytic
