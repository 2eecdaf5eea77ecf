#include "verification/observations/published.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/error.hpp"
#include "kernel/core/random.hpp"
#include "kernel/core/types.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::observations {
namespace {

// Draws in the order of the calls.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : seed_(seed) {}
  double uniform() { return uniform_random(seed_, statistics::stream::drawn_vesicles, index_++); }
  double normal() {
    const double u = uniform();
    return normal_pair(u, uniform())[0];
  }

 private:
  std::uint64_t seed_, index_ = 0;
};

MeasuredVesicles described(const PublishedFacts& facts) {
  MeasuredVesicles data;
  data.name = facts.name + ", SYNTHETIC";
  data.synthetic = true;
  data.origin = facts.origin;
  data.composition = facts.composition;
  data.celsius = facts.celsius;
  return data;
}

// The number of looks at one vesicle. Looks are shared out as evenly as whole numbers go.
int looks_at(std::int64_t vesicle, std::int64_t vesicles, std::int64_t measurements) {
  return static_cast<int>(measurements * (vesicle + 1) / vesicles -
                          measurements * vesicle / vesicles);
}

std::vector<double> draw_times(Draws& draw, int count, const statistics::Window& window) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i)
    times.push_back(window.begin * std::pow(window.end / window.begin, draw.uniform()));
  std::sort(times.begin(), times.end());
  return times;
}

double draw_radius(Draws& draw, const PublishedFacts& facts) {
  return facts.radius_min + (facts.radius_max - facts.radius_min) * draw.uniform();
}

std::string vesicle_name(int index) {
  return "v" + std::to_string(index + 1);
}

constexpr double kLeastRaft = 0.001;
const double kShare = std::sqrt(0.5);  // of a deviation, when half of the variance is common

}  // namespace

MeasuredVesicles draw_measurements(const PublishedFacts& facts, std::uint64_t seed) {
  MeasuredVesicles data = described(facts);
  data.time_zero = "as in the paper: the sample leaves the hot plate";
  Draws draw(seed);
  for (int k = 0; k < facts.vesicles; ++k) {
    const double radius = draw_radius(draw, facts);
    const double own_perimeter = draw.normal(), own_fraction = draw.normal();
    for (const double t :
         draw_times(draw, looks_at(k, facts.vesicles, facts.measurements), facts.window)) {
      // The vesicle's own values come first; measuring adds to them. Rafts are counted without
      // error.
      double perimeter =
          facts.perimeter.at(t) * std::exp(facts.perimeter.scatter * kShare * own_perimeter);
      double fraction = std::max(0.01, facts.fraction + facts.fraction_sd * kShare * own_fraction);
      const double rafts = std::max(1.0, std::round(equal_caps(perimeter, fraction)));
      perimeter *= std::exp(facts.perimeter.scatter * kShare * draw.normal());
      fraction = std::max(0.01, fraction + facts.fraction_sd * kShare * draw.normal());
      data.measurements.push_back(
          {vesicle_name(k),
           t,
           radius,
           {perimeter, rafts, fraction},
           {perimeter * facts.perimeter.scatter * kShare, std::nullopt, facts.fraction_sd}});
    }
  }
  return data;
}

MeasuredVesicles draw_from_runs(const PublishedFacts& facts, const std::vector<History>& runs,
                                double radius, std::uint64_t seed) {
  MeasuredVesicles data = described(facts);
  data.name = "simulated vesicles, looked at as " + facts.name + ", SYNTHETIC";
  data.origin = "simulated runs; times and scatter as in " + facts.origin;
  data.composition.clear();
  data.celsius.reset();
  data.time_zero = "the start of the simulated runs";
  if (runs.empty()) throw InputError("there is no finished run to draw from");
  const int vesicles = std::min(facts.vesicles, static_cast<int>(runs.size()));
  Draws draw(seed);
  for (int k = 0; k < vesicles; ++k) {
    const History& run = runs[k];
    if (run.time.empty() || run.time.back() < facts.window.end)
      throw InputError("the runs end before the window of the facts does");
    (void)draw.uniform();  // was a radius: sets of results.md stay what they are
    for (const double t :
         draw_times(draw, looks_at(k, vesicles, facts.measurements), facts.window)) {
      const double rafts = run.at(Quantity::rafts, t);
      double perimeter =
          run.at(Quantity::perimeter, t) * std::exp(facts.perimeter.scatter * draw.normal());
      double fraction =
          std::clamp(run.at(Quantity::fraction, t) + facts.fraction_sd * kShare * draw.normal(),
                     kLeastRaft, 1 - kLeastRaft);
      if (rafts == 0) perimeter = fraction = 0;  // nothing to be seen
      data.measurements.push_back(
          {vesicle_name(k),
           t,
           radius,
           {perimeter, rafts, fraction},
           {perimeter * facts.perimeter.scatter, std::nullopt, facts.fraction_sd * kShare}});
    }
  }
  return data;
}

}  // namespace traceraft::observations
