#include "verification/observations/differences.hpp"

#include <cmath>

#include "kernel/core/text.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::observations {
namespace {

constexpr double kSameSize = 1.2;                       // ratio of radii
constexpr double kDeviations = 2, kSameFraction = 0.1;  // the latter relative

std::string difference_of_radii(const MeasuredVesicles& data, double radius) {
  std::vector<double> radii;
  for (const auto& [first, last] : data.vesicles())
    radii.push_back(data.measurements[first].radius);
  const statistics::Sample d = statistics::sample_of(radii);
  if (d.max <= kSameSize * radius && d.min >= radius / kSameSize) return "";
  return formatted(
             "The vesicles have radii of %.3g to %.3g um (median %.3g um); the simulated one has "
             "%.3g um. At the same time, larger vesicles have more rafts and a larger perimeter / "
             "radius. Part of a deviation may be due to this. ",
             d.min, d.max, d.median, radius) +
         effect_of_size(data, radius) + " and as many more --cells.";
}

std::string difference_of_fractions(const MeasuredVesicles& data, double fraction) {
  std::vector<double> means;
  for (const auto& vesicle : fractions_of_vesicles(data))
    if (vesicle) means.push_back(vesicle->mean);
  if (means.size() < 2) return "";
  const statistics::Sample d = statistics::sample_of(means);
  const double off = std::fabs(d.mean - fraction);
  if (off <= kDeviations * d.deviation || off <= kSameFraction * fraction) return "";
  return formatted(
      "Rafts cover %.3g of the area of the vesicles (standard deviation %.2g), but %.3g of the "
      "simulated one. Do membrane and temperature agree?",
      d.mean, d.deviation, fraction);
}

}  // namespace

SimulatedVesicle simulated_vesicle(double radius, const std::vector<History>& runs,
                                   const MeasuredVesicles& data) {
  double sum = 0, count = 0;
  for (const auto& vesicle : fractions_of_vesicles(data)) {
    if (!vesicle) continue;
    for (const History& run : runs)
      for (const double t : vesicle->times)
        sum += run.at(Quantity::fraction, t) / static_cast<double>(vesicle->times.size());
    count += static_cast<double>(runs.size());
  }
  return {radius, count > 0 ? sum / count : 0};
}

double factor_of_size(const MeasuredVesicles& data, double radius) {
  double sum = 0, count = 0;
  for (const Measurement& m : data.measurements) {
    if (!m.shows_rafts()) continue;
    sum += std::log(m.radius / radius);
    ++count;
  }
  return count > 0 ? std::exp(4 * sum / count) : 1;
}

std::string effect_of_size(const MeasuredVesicles& data, double radius) {
  const double factor = factor_of_size(data, radius);
  return formatted(
      "The effective radius, the geometric mean over the observations with rafts, is %.3g um. "
      "Coarsening times grow like R^4, so that D would be %.2g times as large with --radius %.3g",
      radius * std::pow(factor, 0.25), factor, radius * std::pow(factor, 0.25));
}

std::vector<std::string> differences(const MeasuredVesicles& data, const SimulatedVesicle& model) {
  std::vector<std::string> sentences;
  for (const std::string& sentence : {difference_of_radii(data, model.radius),
                                      difference_of_fractions(data, model.raft_fraction)})
    if (!sentence.empty()) sentences.push_back(sentence);
  return sentences;
}

}  // namespace traceraft::observations
