#include "verification/vesicles/joint_fit.hpp"

#include <algorithm>
#include <cmath>

#include "backends/nlopt/minimise.hpp"
#include "verification/measure/fit.hpp"

namespace traceraft {
namespace {

constexpr double kStep = 0.1;  // of the logarithms, at first
constexpr double kTolerance = 1e-3;
constexpr int kMostEvaluations = 300;
// Shares are given in per cent, rounded; where all are the same that is what is known.
constexpr double kLeastFractionVariance = 0.01 * 0.01 / 12;

TimeFit with_fractions(const Evidence& all, const RunStatistics& runs, TimeFit fit) {
  if (all.fractions)
    fit.deviance += all.fractions->deviance(all.sample, runs, fit.seconds_per_unit);
  return fit;
}

}  // namespace

MeasuredFractions::MeasuredFractions(const MeasuredVesicles& data)
    : vesicles_(fractions_of_vesicles(data)) {
  std::vector<double> known;
  for (const auto& vesicle : vesicles_)
    if (vesicle) known.push_back(vesicle->mean);
  if (known.size() > 1)
    variance_ = std::max(std::pow(moments(known).deviation, 2), kLeastFractionVariance);
}

double MeasuredFractions::deviance(const std::vector<int>& sample, const RunStatistics& runs,
                                   double seconds_per_unit) const {
  if (!(variance_ > 0)) return 0;
  double sum = 0;
  for (const int k : sample) {
    const auto& vesicle = vesicles_[static_cast<std::size_t>(k)];
    if (!vesicle) continue;
    double simulated = 0;
    for (const double t : vesicle->times) simulated += runs.fraction(t / seconds_per_unit);
    simulated /= static_cast<double>(vesicle->times.size());
    sum += std::pow(vesicle->mean - simulated, 2) / variance_;
  }
  return sum;
}

TimeFit Evidence::fit(const RunStatistics& runs) const {
  return with_fractions(*this, runs, fit_time(data, sample, runs, unit));
}

TimeFit Evidence::fit(const RunStatistics& runs, const TimeFit& near) const {
  return with_fractions(*this, runs, fit_time(data, sample, runs, unit, near));
}

JointFit fit_jointly(const Evidence& evidence, const RunEmulator& runs, const Box& box,
                     const std::vector<JointFit>& starts) {
  JointFit best;
  best.time.deviance = HUGE_VAL;
  for (const JointFit& start : starts) {
    TimeFit near = start.time;
    const auto profile = [&](const std::vector<double>& ln) {
      const TimeFit here = evidence.fit(runs.at(ln), near);
      near = here;
      if (here.deviance < best.time.deviance) best = {ln, here};
      return here.deviance;
    };
    std::vector<double> first = start.ln_parameters;
    for (std::size_t i = 0; i < first.size(); ++i)
      first[i] = std::clamp(first[i], box.lower[i], box.upper[i]);
    if (first.empty())
      (void)profile(first);
    else
      (void)minimise({profile, first, box.lower, box.upper,
                      std::vector<double>(first.size(), kStep), kTolerance, kMostEvaluations});
  }
  return best;
}

}  // namespace traceraft
