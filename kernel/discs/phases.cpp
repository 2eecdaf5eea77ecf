#include "kernel/discs/phases.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/discs/disc.hpp"

namespace traceraft::discs {
namespace {

constexpr int kIntervals = 256;     // of the table, between c = 0 and the spinodal
constexpr int kBelow = 320;         // and below 0, to about −¼
constexpr double kCertainly = 0.9;  // of the largest potential: a disc dissolves

// The smaller c with f0''(c) = 0.
double spinodal(const physics::DoubleWell& well) {
  return 0.5 * (well.a + well.b) - (well.b - well.a) / std::sqrt(12.0);
}

}  // namespace

double boundary_mass(const physics::DoubleWell& well, double epsilon) {
  return kPi * kPi * kPi * epsilon * epsilon / (6 * well.rho);
}

double contact_distance(const physics::DoubleWell& well, double epsilon) {
  return 2 * std::log(3.0) * epsilon / std::sqrt(2 * well.rho);
}

Phases::Phases(const DiscModel& model)
    : mobility_(model.mobility),
      well_(model.well),
      profile_length_(model.epsilon / std::sqrt(2 * model.well.rho)),
      line_tension_(model.epsilon * model.well.interface_energy()),
      largest_potential_(well_.derivative(spinodal(well_))) {
  boundary_mass_ = discs::boundary_mass(well_, model.epsilon);
  contact_distance_ = discs::contact_distance(well_, model.epsilon);
  smallest_area_ = area_of_half_angle(std::atan(line_tension_ / (kCertainly * largest_potential_)));
  spacing_ = spinodal(well_) / kIntervals;
  lowest_ = -kBelow * spacing_;
  // Simpson's rule in each interval; c = 0, where M may have a kink, is the end of one.
  table_.assign(kBelow + kIntervals + 1, 0);
  const auto integral = [&](double c) {
    return spacing_ / 6 *
           (flux_potential_slope(c) + 4 * flux_potential_slope(c + 0.5 * spacing_) +
            flux_potential_slope(c + spacing_));
  };
  for (std::size_t k = kBelow; k < kBelow + kIntervals; ++k)
    table_[k + 1] = table_[k] + integral(lowest_ + static_cast<double>(k) * spacing_);
  for (std::size_t k = kBelow; k > 0; --k)
    table_[k - 1] = table_[k] - integral(lowest_ + static_cast<double>(k - 1) * spacing_);
}

double Phases::mobility(double c) const {
  double value = 0;
  mobility_->evaluate(&c, 1, &value, nullptr);
  return std::max(value, 0.0);
}

double Phases::potential(double area) const {
  return line_tension_ * curvature(area);
}

// f0' rises on the branch.
double Phases::outside(double potential) const {
  double low = lowest_, high = spinodal(well_);
  if (potential >= largest_potential_) return high;
  if (potential <= well_.derivative(low)) return low;
  double c = std::clamp(potential / well_.second(0), low, high);
  for (int k = 0; k < 60; ++k) {
    const double excess = well_.derivative(c) - potential;
    (excess > 0 ? high : low) = c;
    const double next = c - excess / well_.second(c);
    const double taken = next > low && next < high ? next : 0.5 * (low + high);
    if (std::fabs(taken - c) <= 1e-15) return taken;
    c = taken;
  }
  return c;
}

// f0' is odd about ½.
double Phases::inside(double potential) const {
  return 1 - outside(-potential);
}

double Phases::flux_potential_slope(double c) const {
  return mobility(c) * well_.second(c);
}

// Cubic, with the slopes at both ends.
double Phases::flux_potential(double c) const {
  const double place = std::clamp((c - lowest_) / spacing_, 0.0, kBelow + kIntervals - 1e-9);
  const auto k = static_cast<std::size_t>(place);
  const double s = place - static_cast<double>(k),
               left = lowest_ + static_cast<double>(k) * spacing_;
  const double first = spacing_ * flux_potential_slope(left),
               last = spacing_ * flux_potential_slope(left + spacing_),
               rise = table_[k + 1] - table_[k];
  return table_[k] +
         s * (first + s * (3 * rise - 2 * first - last + s * (first + last - 2 * rise)));
}

double Phases::tail(double potential) const {
  const double m = std::max(mobility(outside(potential)), 1e-12);
  return profile_length_ * std::log1p(1 / m);
}

double Phases::mass(double area) const {
  return area * inside(potential(area)) + boundary_mass_;
}

// dκ/d(area) = −1/(2π sin³α).
double Phases::mass_slope(double area) const {
  const double c = inside(potential(area)), sine = sine_of_half_angle(area);
  return c - area * line_tension_ / (2 * kPi * sine * sine * sine) / well_.second(c);
}

double Phases::area_of_mass(double mass_of_disc) const {
  double area = std::max(smallest_area_, mass_of_disc - boundary_mass_);
  for (int k = 0; k < 50; ++k) {
    const double step = (mass_of_disc - mass(area)) / mass_slope(area);
    area = std::max(0.5 * smallest_area_, area + step);
    if (std::fabs(step) <= 1e-14 * area) break;
  }
  return area;
}

}  // namespace traceraft::discs
