// The quantities that microscopes and simulations both tell of a vesicle, as functions of time.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "verification/statistics/sample.hpp"

namespace traceraft::observations {

// The three quantities of Zhiliakov et al. (BBA Biomembranes 1863 (2021) 183446): total length of
// the raft boundaries over the radius, number of rafts, and their share of the area.
enum class Quantity { perimeter, rafts, fraction };
inline constexpr std::array<Quantity, 3> kQuantities = {Quantity::perimeter, Quantity::rafts,
                                                        Quantity::fraction};
constexpr std::size_t index_of(Quantity quantity) {
  return static_cast<std::size_t>(quantity);
}
struct QuantityName {
  const char* id;     // in files
  const char* label;  // for people
};
QuantityName name_of(Quantity quantity);

// One vesicle: values at ascending times (s).
struct History {
  std::vector<double> time;
  std::array<std::vector<double>, 3> values;  // in the order of kQuantities

  std::vector<double>& of(Quantity quantity) { return values[index_of(quantity)]; }
  const std::vector<double>& of(Quantity quantity) const { return values[index_of(quantity)]; }
  // Linear between the times; the number of rafts is that of the time before. The first or the last
  // value beyond the ends. At least one time.
  double at(Quantity quantity, double t) const;
};

// The logarithm by which quantities that scatter in proportion are compared. There may be no raft
// for a moment; half a one, or one of a perimeter of R/2, is the least that is told from that.
double logarithm_of(Quantity quantity, double value);

// Times per decade at which curves are known.
inline constexpr int kCurveTimes = 20;

// Evenly spaced in ln t, `per_decade` of them, within what all histories cover (their first
// positive times, their last ones). Empty if that is nothing.
std::vector<double> common_times(const std::vector<History>& histories, int per_decade);

// A quantity of several histories at each of the times.
std::vector<statistics::Sample> samples_at(const std::vector<History>& histories, Quantity quantity,
                                           const std::vector<double>& times);

}  // namespace traceraft::observations
