#include "verification/vesicles/published.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/random.hpp"
#include "kernel/core/types.hpp"

namespace traceraft {
namespace {

// Draws in the order of the calls.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : seed_(seed) {}
  double uniform() { return uniform_random(seed_, 17, index_++); }
  double normal() {  // Box and Muller
    const double r = std::sqrt(-2 * std::log(uniform()));
    return r * std::cos(2 * kPi * uniform());
  }

 private:
  std::uint64_t seed_, index_ = 0;
};

}  // namespace

MeasuredVesicles draw_measurements(const PublishedFacts& facts, std::uint64_t seed) {
  MeasuredVesicles data;
  data.name = facts.name + ", synthetic";
  data.synthetic = true;
  data.origin = facts.origin;
  data.composition = facts.composition;
  data.celsius = facts.celsius;
  data.time_zero = "as in the paper: the sample leaves the hot plate";
  Draws draw(seed);
  const double share = std::sqrt(0.5);  // of a deviation, when half of the variance is common
  for (int k = 0; k < facts.vesicles; ++k) {
    // As evenly as whole numbers go.
    const int looks =
        facts.measurements * (k + 1) / facts.vesicles - facts.measurements * k / facts.vesicles;
    const double radius = facts.radius_min + (facts.radius_max - facts.radius_min) * draw.uniform();
    const double own_perimeter = draw.normal(), own_fraction = draw.normal();
    std::vector<double> times;
    for (int i = 0; i < looks; ++i)
      times.push_back(facts.window.begin *
                      std::pow(facts.window.end / facts.window.begin, draw.uniform()));
    std::sort(times.begin(), times.end());
    for (const double t : times) {
      const double perimeter = facts.perimeter.at(t) * std::exp(facts.perimeter.scatter * share *
                                                                (own_perimeter + draw.normal()));
      const double fraction = std::max(
          0.01, facts.fraction + facts.fraction_sd * share * (own_fraction + draw.normal()));
      data.measurements.push_back(
          {"v" + std::to_string(k + 1),
           t,
           radius,
           {perimeter, std::max(1.0, std::round(equal_caps(perimeter, fraction))), fraction},
           {}});
    }
  }
  return data;
}

}  // namespace traceraft
