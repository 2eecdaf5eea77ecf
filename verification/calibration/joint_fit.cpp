#include "verification/calibration/joint_fit.hpp"

#include <algorithm>
#include <cmath>

#include "backends/nlopt/minimise.hpp"

namespace traceraft {
namespace {

constexpr double kStep = 0.1;  // first step of the logarithms
constexpr double kTolerance = 1e-3;
constexpr int kMostEvaluations = 300;

}  // namespace

JointFit fit_jointly(const Evidence& evidence, const RunEmulator& runs, const Box& box,
                     const std::vector<JointFit>& starts) {
  JointFit best;
  best.fit.deviance = HUGE_VAL;
  for (const JointFit& start : starts) {
    EnsembleFit near = start.fit;
    const auto profile = [&](const std::vector<double>& ln) {
      const EnsembleFit here = evidence.fit(runs.at(ln), near);
      near = here;
      if (here.deviance < best.fit.deviance) best = {ln, here};
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
