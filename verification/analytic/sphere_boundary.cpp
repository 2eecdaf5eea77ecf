#include "verification/analytic/sphere_boundary.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/core/types.hpp"

namespace traceraft::analytic {
namespace {

constexpr int kCells = 20000;  // errors below 1e-6 from ε = 0.02 on
constexpr double kWidth = 0.5 * kPi / kCells;
constexpr int kMaxNewton = 30;
constexpr double kNewtonTolerance = 1e-13;

double latitude_of(double index) {
  return (index + 0.5) * kWidth;
}

// Finite volumes in latitude: per cell ε² [cos φ c'] over its faces − cos φ f0'(c) · width. The
// face at the equator holds the value (a + b)/2, half a cell away; cos φ = 0 closes the pole.
struct Balance {
  Vec residual;
  Eigen::SparseMatrix<double> jacobian;
};

Balance balance(const physics::DoubleWell& well, double epsilon, const Vec& c) {
  const double diffusion = epsilon * epsilon / kWidth;
  Balance result{Vec::Zero(kCells), Eigen::SparseMatrix<double>(kCells, kCells)};
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < kCells; ++i) {
    const double volume = std::cos(latitude_of(i)) * kWidth;
    result.residual[i] -= volume * well.derivative(c[i]);
    entries.emplace_back(i, i, -volume * well.second(c[i]));
    if (i == 0) {
      result.residual[i] += 2 * diffusion * (0.5 * (well.a + well.b) - c[i]);
      entries.emplace_back(i, i, -2 * diffusion);
    }
    if (i + 1 == kCells) continue;
    const double face = diffusion * std::cos(latitude_of(i + 0.5));
    const double flux = face * (c[i + 1] - c[i]);
    result.residual[i] += flux;
    result.residual[i + 1] -= flux;
    for (const int row : {i, i + 1})
      for (const int column : {i, i + 1})
        entries.emplace_back(row, column, row == column ? -face : face);
  }
  result.jacobian.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace

SphereBoundary::SphereBoundary(const physics::DoubleWell& well, double epsilon) : well_(well) {
  Vec c(kCells);
  for (int i = 0; i < kCells; ++i) c[i] = well.profile(-latitude_of(i), epsilon);
  double change = 1;
  for (int i = 0; i < kMaxNewton && change > kNewtonTolerance; ++i) {
    const Balance at = balance(well, epsilon, c);
    const Eigen::SparseLU<Eigen::SparseMatrix<double>> factors(at.jacobian);
    const Vec step = factors.solve(at.residual);
    c -= step;
    change = step.lpNorm<Eigen::Infinity>();
  }
  if (!(change <= kNewtonTolerance))
    throw std::runtime_error("the profile of a boundary on the sphere did not converge");

  c_.assign(c.data(), c.data() + c.size());
  double before = 0.5 * (well.a + well.b);
  for (int i = 0; i < kCells; ++i) {
    const double ring = 4 * kPi * std::cos(latitude_of(i)) * kWidth;  // both hemispheres
    energy_ += ring * well.energy(c[i]);
    width_ += ring * (c[i] - well.a) * (well.b - c[i]);
    const double distance = i == 0 ? 0.5 * kWidth : kWidth;
    const double face = i == 0 ? 0.25 * kWidth : i * kWidth;  // the middle of that distance
    const double slope = (c[i] - before) / distance;
    energy_ += 4 * kPi * std::cos(face) * distance * 0.5 * epsilon * epsilon * slope * slope;
    before = c[i];
  }
}

double SphereBoundary::profile(double latitude) const {
  const double north = std::fabs(latitude) / kWidth - 0.5;
  const double middle = 0.5 * (well_.a + well_.b);
  double c = 0;
  if (north < 0) {
    c = middle + (c_.front() - middle) * (2 * north + 1);
  } else {
    const int i = std::min(static_cast<int>(north), kCells - 2);
    c = c_[i] + std::min(north - i, 1.0) * (c_[i + 1] - c_[i]);
  }
  return latitude < 0 ? well_.a + well_.b - c : c;
}

}  // namespace traceraft::analytic
