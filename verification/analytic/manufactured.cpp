#include "verification/analytic/manufactured.hpp"

#include <cmath>
#include <stdexcept>

#include "kernel/fem/sparse_view.hpp"
#include "kernel/problem/prescribed_density.hpp"
#include "verification/analytic/surface_calculus.hpp"

namespace traceraft::analytic {
namespace {

constexpr double kAmplitude = 0.25;

Point as_point(const Vector3<double>& v) {
  return Point(v[0], v[1], v[2]);
}

template <class Surface>
SurfaceFunction on(const Surface& F) {
  const auto u = [](const auto& x) { return x[0] * x[1] * x[2]; };
  const auto laplacian = laplace_beltrami(F, u);
  return [=](const Point& near) {
    const Point at = point_on(F, near);
    const auto x = with_derivatives(Vector3<double>{at[0], at[1], at[2]});
    const LocalSurface<double> local(F(x));
    const Jet<double> value = u(x), L = laplacian(x);
    return SurfacePoint{value.value, L.value, local.laplace_beltrami(L),
                        as_point(local.tangential_gradient(value)),
                        as_point(local.tangential_gradient(L))};
  };
}

// g with ∂c/∂t − ∇·(M(c) ∇μ) = g for c = ½ + a u.
double source(const physics::DoubleWell& well, double epsilon, double a, double rate,
              const SurfacePoint& p) {
  const double c = 0.5 + a * p.u, e2 = epsilon * epsilon;
  const double M = c * (1 - c), dM = 1 - 2 * c;
  const double f2 = well.second(c), f3 = 2 * well.rho * 6 * (2 * c - well.a - well.b);
  const double slope_squared = a * a * p.gradient.squaredNorm();
  const double laplacian_mu = f2 * a * p.laplacian + f3 * slope_squared - e2 * a * p.bilaplacian;
  const double slope_product =
      f2 * slope_squared - e2 * a * a * p.gradient.dot(p.laplacian_gradient);
  return rate * p.u - M * laplacian_mu - dM * slope_product;
}

problem::EffectPtr manufactured_source(const fem::SurfaceSpace& space, const std::string& surface,
                                       const physics::DoubleWell& well, double epsilon) {
  const auto function = surface_function(surface);
  // u = xyz and its derivatives do not change in time. They are computed once, at every point of
  // the quadrature.
  const auto points =
      std::make_shared<std::vector<SurfacePoint>>(fem::quadrature_points(space.surface));
  space.team->for_range(space.surface.triangles.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t triangle = begin; triangle < end; ++triangle)
      fem::for_each_quadrature_point(space.surface, triangle, [&](const fem::QuadraturePoint& at) {
        (*points)[at.number] = function(at.x);
      });
  });
  return problem::prescribed_density(
      "manufactured source", problem::Slot::source, [=](const fem::QuadraturePoint& at, double t) {
        return -source(well, epsilon, kAmplitude * std::cos(t), -kAmplitude * std::sin(t),
                       (*points)[at.number]);
      });
}

}  // namespace

SurfaceFunction surface_function(const std::string& surface) {
  if (surface == "sphere")
    return on([](const auto& x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 1.0; });
  if (surface == "ellipsoid")
    return on([](const auto& x) {
      return (1 / 1.44) * x[0] * x[0] + x[1] * x[1] + (1 / 0.64) * x[2] * x[2] - 1.0;
    });
  if (surface == "torus")
    return on([](const auto& x) {
      using std::sqrt;
      const auto tube = sqrt(x[0] * x[0] + x[1] * x[1]) - 1.0;
      return tube * tube + x[2] * x[2] - 0.16;
    });
  throw std::logic_error("no manufactured solution on " + surface);
}

bench::ErrorNorms stationary_error(const fem::SurfaceSpace& space,
                                   const SurfaceFunction& function) {
  const fem::CsrMatrix stiffness =
      fem::combine(1, space.stiffness, space.h(), space.normal_stiffness);
  const fem::CsrMatrix A = fem::combine(1, stiffness, 1, space.mass);
  Vec b = Vec::Zero(space.nodes());
  fem::add_density_load(
      space, 1,
      [&](const fem::QuadraturePoint& at) {
        const SurfacePoint p = function(at.x);
        return p.u - p.laplacian;
      },
      b);
  // Conjugate gradients with Eigen, independent of the program's own solvers.
  const fem::EigenMatrix matrix = fem::as_eigen(space, A);
  Eigen::ConjugateGradient<fem::EigenMatrix, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(1e-12);
  solver.compute(matrix);
  const Vec solution = solver.solve(b);
  if (solver.info() != Eigen::Success) throw std::runtime_error("conjugate gradients failed");
  return bench::error_norms(space, solution,
                            {[&](const Point& x) { return function(x).u; },
                             [&](const Point& x) { return function(x).gradient; }});
}

ManufacturedCahnHilliard::ManufacturedCahnHilliard(const bench::Bench& bench, bench::SpacePtr space,
                                                   std::string surface_, double epsilon)
    : surface(std::move(surface_)) {
  problem::CahnHilliardModel model = bench::bench_model("degenerate", epsilon);
  model.effects.push_back(manufactured_source(*space, surface, model.well, epsilon));
  problem = bench.problem(std::move(space), model);
}

bench::ExactFunction ManufacturedCahnHilliard::c(double t) const {
  const double a = kAmplitude * std::cos(t);
  const auto function = surface_function(surface);
  return {[=](const Point& x) { return 0.5 + a * function(x).u; },
          [=](const Point& x) { return Point(a * function(x).gradient); }};
}

bench::ExactFunction ManufacturedCahnHilliard::mu(double t) const {
  const double a = kAmplitude * std::cos(t), epsilon = problem->model().epsilon;
  const double e2 = epsilon * epsilon;
  const physics::DoubleWell well = problem->model().well;
  const auto function = surface_function(surface);
  return {
      [=](const Point& x) {
        const SurfacePoint p = function(x);
        return well.derivative(0.5 + a * p.u) - e2 * a * p.laplacian;
      },
      [=](const Point& x) {
        const SurfacePoint p = function(x);
        return Point(well.second(0.5 + a * p.u) * a * p.gradient - e2 * a * p.laplacian_gradient);
      }};
}

bench::StartState ManufacturedCahnHilliard::initial_state() const {
  const bench::ExactFunction exact = c(0);
  Vec nodal(space().nodes());
  for (int i = 0; i < space().nodes(); ++i) nodal[i] = exact.value(space().mesh.position(i));
  return bench::consistent_state(*problem, nodal);
}

}  // namespace traceraft::analytic
