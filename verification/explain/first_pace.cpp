#include "verification/explain/first_pace.hpp"

#include <algorithm>
#include <cmath>

#include "verification/explain/score_test.hpp"

namespace traceraft {
namespace {

constexpr int kRank = 80, kTangentSteps = 2, kMostSteps = 12;
// Of ln D: at most in one pass, and what is left to other searches.
constexpr double kLargestStep = 0.7, kGoodEnough = 0.02;

}  // namespace

double first_pace(const FilterProblems& data, const CahnHilliardModel& base,
                  const FilterSettings& settings) {
  FilterSettings rough = settings;
  rough.rank = kRank;
  rough.replicates = 0;
  rough.tangent_steps = kTangentSteps;
  FilterModel model{base, 1, {}, {}};
  std::vector<ErrorMaps> maps;
  for (int k = 0; k < kMostSteps; ++k) {
    const double change = screen(filter_fields(data, model, rough, maps), {}, {}).pace_change;
    const double step = std::clamp(change, -kLargestStep, kLargestStep);
    model.pace *= std::exp(step);
    if (std::fabs(step) < kGoodEnough) break;
  }
  return model.pace;
}

}  // namespace traceraft
