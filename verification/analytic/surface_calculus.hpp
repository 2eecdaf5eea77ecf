// Exact derivatives on implicit surfaces F(x) = 0 for functions that are given in space:
//   Δ_Γ u = Δu − nᵀ(∇²u) n − (div n) n·∇u,   n = ∇F/|∇F|,   div n = (ΔF − nᵀ(∇²F) n)/|∇F|
// (Dziuk, Elliott, Finite element methods for surface PDEs, Acta Numerica 22 (2013), section 2).
// They hold on the level set of F through x, whatever u does away from it. F and u take points of
// any scalar type: double or jets.
#pragma once

#include "kernel/core/types.hpp"
#include "verification/analytic/jet.hpp"

namespace traceraft::analytic {

template <class T>
using Vector3 = std::array<T, 3>;

template <class T>
Vector3<Jet<T>> with_derivatives(const Vector3<T>& x) {
  Vector3<Jet<T>> result;
  for (int i = 0; i < 3; ++i) {
    result[i].value = x[i];
    result[i].gradient[i] = T(1.0);
  }
  return result;
}

template <class T>
T dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Tr(H) − nᵀ H n of the Hessian in u.
template <class T>
T tangential_trace(const Jet<T>& u, const Vector3<T>& n) {
  T result = u.second(0, 0) + u.second(1, 1) + u.second(2, 2);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) result += -(n[i] * n[j] * u.second(i, j));
  return result;
}

// The surface at x.
template <class T>
struct LocalSurface {
  Vector3<T> normal;
  T div_normal;

  explicit LocalSurface(const Jet<T>& F) : normal(F.gradient) {
    using std::sqrt;
    const T inverse_slope = inverse(sqrt(dot(F.gradient, F.gradient)));
    for (T& component : normal) component = component * inverse_slope;
    div_normal = tangential_trace(F, normal) * inverse_slope;
  }
  T laplace_beltrami(const Jet<T>& u) const {
    return tangential_trace(u, normal) + -(div_normal * dot(normal, u.gradient));
  }
  Vector3<T> tangential_gradient(const Jet<T>& u) const {
    const T along = dot(normal, u.gradient);
    Vector3<T> result = u.gradient;
    for (int i = 0; i < 3; ++i) result[i] += -(along * normal[i]);
    return result;
  }
};

// x ↦ Δ_Γ u(x) as a function of points of any scalar type.
template <class Surface, class Function>
auto laplace_beltrami(const Surface& F, const Function& u) {
  return [=](const auto& x) {
    const auto jets = with_derivatives(x);
    return LocalSurface(F(jets)).laplace_beltrami(u(jets));
  };
}

// A point of the surface near x: Newton's method along ∇F. Its derivative along n vanishes on the
// surface, as that of the closest point does.
template <class Surface>
Point point_on(const Surface& F, Point x) {
  for (int i = 0; i < 5; ++i) {
    const Jet<double> f = F(with_derivatives(Vector3<double>{x[0], x[1], x[2]}));
    const Point slope(f.gradient[0], f.gradient[1], f.gradient[2]);
    x -= f.value / slope.squaredNorm() * slope;
  }
  return x;
}

}  // namespace traceraft::analytic
