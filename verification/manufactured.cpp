#include "verification/manufactured.hpp"

#include <Eigen/Sparse>
#include <cmath>
#include <stdexcept>

namespace traceraft {
namespace {

constexpr double kAmplitude = 0.25;

double harmonic(const Point& x) {
  const Point u = x.normalized();
  return u[0] * u[1] * u[2];
}

// |∇_Γ Y|² on the unit sphere.
double harmonic_slope_squared(const Point& x) {
  const Point u = x.normalized();
  const double a = u[1] * u[2], b = u[0] * u[2], c = u[0] * u[1];
  return a * a + b * b + c * c - 9 * u[0] * u[0] * a * a;
}

Point harmonic_gradient(const Point& x) {
  const double r = x.norm();
  const Point u = x / r;
  const Point cubic(u[1] * u[2], u[0] * u[2], u[0] * u[1]);
  return (cubic - 3 * harmonic(x) * u) / r;
}

// Load vector ∫ f v of a function given near Γ.
Vec load(const SurfaceSpace& space, const std::function<double(const Point&)>& f) {
  Vec first = Vec::Zero(space.nodes()), second = Vec::Zero(space.nodes());
  prescribed_density("load", Slot::source, [&](const Point& x, double) {
    return f(x);
  })->add_residual(space, 0, first, first, second, first);
  return second;
}

}  // namespace

ExactFunction harmonic_three() {
  return {harmonic, harmonic_gradient};
}

ErrorNorms stationary_error(const SurfaceSpace& space) {
  const CsrMatrix stiffness = combine(1, space.stiffness, space.h(), space.normal);
  const CsrMatrix A = combine(1, stiffness, 1, space.mass);
  const Vec b = load(space, [](const Point& x) { return (kHarmonicEigenvalue + 1) * harmonic(x); });
  // Conjugate gradients with Eigen, independent of the program's own solvers.
  const Eigen::SparseMatrix<double> matrix =
      Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
          space.nodes(), space.nodes(), space.pattern->entries(), space.pattern->row_begin.data(),
          space.pattern->column.data(), A.values.data());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(1e-12);
  solver.compute(matrix);
  const Vec u = solver.solve(b);
  if (solver.info() != Eigen::Success) throw std::runtime_error("conjugate gradients failed");
  return error_norms(space, u, harmonic_three());
}

ManufacturedCahnHilliard::ManufacturedCahnHilliard(std::shared_ptr<const SurfaceSpace> space_,
                                                   double epsilon)
    : space(std::move(space_)) {
  CahnHilliardModel model;
  model.mobility = make_mobility("degenerate");
  model.epsilon = epsilon;
  const DoubleWell well = model.well;
  // ∂c/∂t − ∇·(M(c) ∇μ) with μ = G(c): ∇·(M G' ∇c) = M G' Δc + (M G')' |∇c|².
  const double gradient_term = epsilon * epsilon * kHarmonicEigenvalue;
  model.effects.push_back(
      prescribed_density("manufactured source", Slot::source, [=](const Point& x, double t) {
        const double a = kAmplitude * std::cos(t), y = harmonic(x), c = 0.5 + a * y;
        const double M = c * (1 - c), dM = 1 - 2 * c;
        const double dG = well.second(c) + gradient_term;
        const double ddG = 2 * well.rho * 6 * (2 * c - well.a - well.b);
        const double divergence = -M * dG * kHarmonicEigenvalue * a * y +
                                  (dM * dG + M * ddG) * a * a * harmonic_slope_squared(x);
        const double rate = -kAmplitude * std::sin(t) * y;
        return -(rate - divergence);
      }));
  problem = std::make_unique<CahnHilliard>(space, model);
}

ExactFunction ManufacturedCahnHilliard::c(double t) const {
  const double a = kAmplitude * std::cos(t);
  return {[a](const Point& x) { return 0.5 + a * harmonic(x); },
          [a](const Point& x) { return Point(a * harmonic_gradient(x)); }};
}

ExactFunction ManufacturedCahnHilliard::mu(double t) const {
  const double a = kAmplitude * std::cos(t);
  const double epsilon = problem->model().epsilon;
  const double gradient_term = epsilon * epsilon * kHarmonicEigenvalue;
  const DoubleWell well = problem->model().well;
  return {[=](const Point& x) {
            return well.derivative(0.5 + a * harmonic(x)) + gradient_term * a * harmonic(x);
          },
          [=](const Point& x) {
            const double slope = well.second(0.5 + a * harmonic(x)) + gradient_term;
            return Point(slope * a * harmonic_gradient(x));
          }};
}

Vec ManufacturedCahnHilliard::initial_state(Vec& ydot) const {
  Vec y = Vec::Zero(problem->size());
  ydot = Vec::Zero(problem->size());
  const ExactFunction exact = c(0);
  for (int i = 0; i < space->nodes(); ++i) y[i] = exact.value(space->mesh.position(i));
  const Status status = problem->consistent_initial_state(0, y, ydot);
  if (!status.ok()) throw std::runtime_error(status.why);
  return y;
}

Vec run_with_equal_steps(const ManufacturedCahnHilliard& problem, Integrator& integrator,
                         double t_end) {
  Vec ydot;
  const Vec y = problem.initial_state(ydot);
  Status status = integrator.start(0, y, ydot, t_end);
  while (status.ok() && integrator.time() < t_end) status = integrator.advance();
  if (!status.ok()) throw std::runtime_error(status.why);
  return integrator.state();
}

}  // namespace traceraft
