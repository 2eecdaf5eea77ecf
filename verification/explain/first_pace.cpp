#include "verification/explain/first_pace.hpp"

#include <algorithm>
#include <cmath>

#include "verification/explain/gaps.hpp"
#include "verification/explain/score_test.hpp"

namespace traceraft {
namespace {

constexpr int kRank = 80, kTangentSteps = 2, kMostSteps = 40;
// Of ln D: at most in one pass, and what is left to other searches.
constexpr double kLargestStep = 0.7, kGoodEnough = 0.02;
// A forecast of far too slow a membrane is about what was measured before, and its derivatives tell
// the way to the right pace. Of far too fast a one everything has come to rest, and they tell
// nothing: such a search begins at one of these.
constexpr double kSlower[] = {1.0 / 8, 1.0 / 64, 1.0 / 512};

struct Pass {
  FilterModel model;
  std::vector<ErrorMaps> maps;
  FilterResult result;
};

class PaceSearch {
 public:
  PaceSearch(const FilterProblems& data, const CahnHilliardModel& base,
             const FilterSettings& settings)
      : data_(data), base_(base), rough_(settings) {
    rough_.rank = kRank;
    rough_.replicates = 0;
    rough_.tangent_steps = kTangentSteps;
  }

  double run() const {
    Pass pass = first_pass();
    double pace_of_maps = pass.model.pace;
    for (int k = 0; k < kMostSteps; ++k) {
      if (std::fabs(std::log(pass.model.pace / pace_of_maps)) > kMapsReach) {
        pass.maps = {};
        pace_of_maps = pass.model.pace;
      }
      if (k > 0) pass.result = filter_fields(data_, pass.model, rough_, pass.maps);
      const double change = screen(pass.result, {}, {}).pace_change;
      const double step = std::clamp(change, -kLargestStep, kLargestStep);
      pass.model.pace *= std::exp(step);
      if (std::fabs(step) < kGoodEnough) break;
    }
    return pass.model.pace;
  }

 private:
  // That of the model, or the most probable of some if it is far off.
  Pass first_pass() const {
    Pass best = pass_at(1);
    if (is_near(best.result)) return best;
    for (const double pace : kSlower) {
      Pass slower = pass_at(pace);
      if (slower.result.deviance < best.result.deviance) best = std::move(slower);
    }
    return best;
  }

  static bool is_near(const FilterResult& pass) {
    constexpr double kFarGap = 2;  // measured minus forecast, over what noise makes of it
    return std::fabs(screen(pass, {}, {}).pace_change) < kLargestStep &&
           gaps_of_pass(pass).train < kFarGap * expected_gaps(pass).train;
  }

  Pass pass_at(double pace) const {
    Pass pass{{base_, pace, {}, {}}, {}, {}};
    pass.result = filter_fields(data_, pass.model, rough_, pass.maps);
    return pass;
  }

  const FilterProblems& data_;
  const CahnHilliardModel& base_;
  FilterSettings rough_;
};

}  // namespace

double first_pace(const FilterProblems& data, const CahnHilliardModel& base,
                  const FilterSettings& settings) {
  return PaceSearch(data, base, settings).run();
}

}  // namespace traceraft
