// Measurements of vesicles, in the units of the comparison: s, and lengths over the radius.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "verification/observations/history.hpp"
#include "verification/statistics/power_law.hpp"

namespace traceraft::observations {

// One look at one vesicle.
struct Measurement {
  std::string vesicle;
  double time;    // s since the time zero of the data
  double radius;  // µm
  // In the order of kQuantities; nothing where it was not measured. sigma: one standard deviation.
  std::array<std::optional<double>, 3> values, sigma;

  const std::optional<double>& of(Quantity quantity) const { return values[index_of(quantity)]; }
  double sigma_of(Quantity quantity) const { return sigma[index_of(quantity)].value_or(0); }
  // Rafts whose perimeter or number was measured.
  bool shows_rafts() const {
    return of(Quantity::perimeter).value_or(0) > 0 || of(Quantity::rafts).value_or(0) > 0;
  }
};

struct MeasuredVesicles {
  std::string name;
  bool synthetic = false;  // drawn from a model, not measured
  std::string origin;      // where it comes from, for people
  std::string composition, time_zero;
  std::optional<double> celsius;
  // Those of one vesicle together, at ascending times.
  std::vector<Measurement> measurements;
  double time_unit = 1,  // the unit of the times in their file, in s
      time_offset = 0;   // what their file adds to its times, in that unit

  // First and last index + 1 of each vesicle's measurements.
  std::vector<std::pair<std::size_t, std::size_t>> vesicles() const;
};

// From the first look after time zero to the last one; nothing if there is none, {inf, 0}.
statistics::Window looks(const MeasuredVesicles& data);

// The raft fraction of a vesicle: the mean over the times (s) after time zero at which it was
// measured.
struct FractionOfVesicle {
  double mean;
  std::vector<double> times;
};
// The raft fraction of each vesicle; nothing if it was not measured.
std::vector<std::optional<FractionOfVesicle>> fractions_of_vesicles(const MeasuredVesicles& data);

// A raft as a spherical cap.
struct Cap {
  double base_radius;           // µm
  std::optional<double> sigma;  // of it, one standard deviation
};
// Caps on a sphere of radius r with base radii a ≤ r (Zhiliakov et al.): each has the perimeter
// 2π a, the half angle θ = arcsin(a/r) and the area 2π r² (1 − cos θ). Sets all three quantities,
// and the sigmas of the first and the last if all caps have one: their errors are independent.
void set_caps(Measurement& measurement, const std::vector<Cap>& caps);

// The number of equal caps that have this perimeter over radius together and cover this share of
// the area: P = 2π N sin θ with cos θ = 1 − 2f/N gives N = f + P²/(16 π² f).
double equal_caps(double perimeter, double fraction);

}  // namespace traceraft::observations
