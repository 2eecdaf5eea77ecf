#include "kernel/discs/phases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/discs/disc.hpp"

namespace traceraft::discs {
namespace {

constexpr int kIntervals = 256;          // of the table, between c = 0 and the spinodal
constexpr int kBelow = 320;              // and below 0, to about −¼
constexpr double kSmallestRadius = 1.5;  // in δ

// The smaller c with f0''(c) = 0.
double spinodal(const physics::DoubleWell& well) {
  return 0.5 * (well.a + well.b) - (well.b - well.a) / std::sqrt(12.0);
}

}  // namespace

double boundary_mass(const physics::DoubleWell& well, double epsilon) {
  return kPi * kPi * kPi * epsilon * epsilon / (6 * well.rho);
}

double contact_distance(const physics::DoubleWell& well, double epsilon) {
  return 2 * std::log(2 / spinodal(well) - 1) * epsilon / std::sqrt(2 * well.rho);
}

Phases::Phases(const DiscModel& model)
    : mobility_(model.mobility),
      well_(model.well),
      profile_length_(model.epsilon / std::sqrt(2 * model.well.rho)),
      line_tension_(model.epsilon * model.well.interface_energy()),
      largest_potential_(well_.derivative(spinodal(well_))) {
  contact_distance_ = discs::contact_distance(well_, model.epsilon);
  smallest_area_ = area_of_half_angle(std::atan(kSmallestRadius * profile_length_));
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

RoundBoundaryAt Phases::boundary(double area) const {
  const double sine = sine_of_half_angle(area), cosine = cosine_of_half_angle(area);
  return round_boundary(cosine > 0 ? sine / cosine / profile_length_
                                   : std::numeric_limits<double>::infinity());
}

double Phases::potential(double area) const {
  return line_tension_ * curvature(area) * boundary(area).value.potential;
}

// Between the wells x goes from −1 to 1, and f0' is ½ρ(b − a)³ (x³ − x). The smallest root of x³ −
// x = 2q/√27 by Viète's formula.
double Phases::outside(double potential) const {
  if (potential >= largest_potential_) return spinodal(well_);
  const double width = well_.b - well_.a,
               q = 1.5 * std::sqrt(3.0) * 2 * potential / (well_.rho * width * width * width);
  const double x = -2 / std::sqrt(3.0) *
                   (q > -1 ? std::cos((std::acos(q) - kPi) / 3) : std::cosh(std::acosh(-q) / 3));
  return std::max(lowest_, 0.5 * (well_.a + well_.b + width * x));
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

double Phases::tail(double c) const {
  return profile_length_ * std::log1p(1 / std::max(mobility(c), 1e-12));
}

double Phases::mass(double area) const {
  return area * inside(potential(area)) +
         profile_length_ * profile_length_ * boundary(area).value.held_mass;
}

// dκ/d(area) = −1/(2π sin³α); the radius is tan α.
double Phases::mass_slope(double area) const {
  const double sine = sine_of_half_angle(area), cosine = cosine_of_half_angle(area);
  const RoundBoundaryAt at = boundary(area);
  const double c = inside(line_tension_ * curvature(area) * at.value.potential);
  double potential_slope = -line_tension_ * at.value.potential / (2 * kPi * sine * sine * sine),
         held_slope = 0;
  if (cosine > 0) {
    const double radius_slope = 1 / (2 * kPi * sine * cosine * cosine * profile_length_);
    potential_slope += line_tension_ * curvature(area) * at.slope.potential * radius_slope;
    held_slope = profile_length_ * profile_length_ * at.slope.held_mass * radius_slope;
  }
  return c + area * potential_slope / well_.second(c) + held_slope;
}

double Phases::boundary_energy(double area) const {
  return line_tension_ * perimeter(area) * boundary(area).value.energy;
}

double Phases::diffuse_perimeter(double area) const {
  return perimeter(area) * boundary(area).value.gradients;
}

double Phases::area_of_mass(double mass_of_disc) const {
  double low = 0, high = 4 * kPi, area = std::min(mass_of_disc, 4 * kPi);
  for (int k = 0; k < 100; ++k) {
    const double excess = mass(area) - mass_of_disc;
    (excess > 0 ? high : low) = area;
    const double next = area - excess / mass_slope(area),
                 taken = next > low && next < high ? next : 0.5 * (low + high);
    if (std::fabs(taken - area) <= 1e-14 * area) break;
    area = taken;
  }
  return area;
}

}  // namespace traceraft::discs
