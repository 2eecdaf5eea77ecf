#include "verification/selection/series/series_need.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "verification/selection/search/judgement.hpp"

namespace traceraft::selection {
namespace {

constexpr int kLeastReplicates = 32;           // of sets with more vesicles: means are asked for
constexpr double kLeast = 1e-4, kStep = 0.01;  // of f, and of its logarithm

observations::MeasuredVesicles repeated(const observations::MeasuredVesicles& data, int times) {
  observations::MeasuredVesicles more = data;
  more.measurements.clear();
  for (int k = 0; k < times; ++k)
    for (observations::Measurement m : data.measurements) {
      m.vesicle = std::to_string(k) + "/" + m.vesicle;
      more.measurements.push_back(m);
    }
  return more;
}

// The square of what vesicles have in common, over its error.
double noise_at(const SeriesNoise& noise, double f) {
  const double share = std::max(0.0, (f - 1) / (kMostTimes - 1));
  return std::max(1.0, noise.now + share * (noise.most - noise.now));
}

// The square of what is left of e beyond u, for f times as many vesicles. The looks' products are f
// times as large then, and it is f ee − f² ue²/(f uu + w), w being what is known of D before; here
// without cancellation.
double square(const SeriesProducts& p, double f) {
  const double alike = p.uu > 0 ? p.ue * p.ue / p.uu : 0;
  return f * std::max(p.ee - alike, 0.0) + f * alike * p.known / (f * p.uu + p.known);
}

}  // namespace

std::vector<SeriesNoise> noise_of_more(const observations::MeasuredVesicles& data,
                                       const std::vector<observations::History>& runs,
                                       const std::vector<SeriesCandidate>& candidates,
                                       const likelihood::EnsembleFit& fit,
                                       const likelihood::UnitPrior& unit, const SeriesNull& null) {
  const Vec most =
      null_of(repeated(data, kMostTimes), runs, candidates, fit, unit,
              std::max(kLeastReplicates, static_cast<int>(null.ln_unit.size()) / kMostTimes))
          .mean;
  std::vector<SeriesNoise> noise;
  for (Eigen::Index k = 0; k < most.size(); ++k) noise.push_back({null.mean[k], most[k]});
  return noise;
}

// Upwards from few: what another D does as well saturates, and noise does not.
double times_needed(const SeriesProducts& products, const SeriesNoise& noise) {
  for (double ln_f = std::log(kLeast); ln_f < std::log(double{kMostTimes}); ln_f += kStep)
    if (square(products, std::exp(ln_f)) >= kSeen * kSeen * noise_at(noise, std::exp(ln_f)))
      return std::exp(ln_f);
  return std::numeric_limits<double>::infinity();
}

}  // namespace traceraft::selection
