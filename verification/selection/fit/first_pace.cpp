#include "verification/selection/fit/first_pace.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "verification/assimilation/filter/gaps.hpp"
#include "verification/selection/fit/refit_unknowns.hpp"
#include "verification/selection/fit/score_test.hpp"

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
  PaceSearch(const FilterProblems& data, const FilterModel& model, const FilterSettings& settings)
      : data_(data), model_(model), rough_(settings) {
    rough_.rank = kRank;
    rough_.replicates = 0;
    rough_.tangent_steps = kTangentSteps;
  }

  FilterModel run() const {
    Pass pass = first_pass();
    double pace_of_maps = pass.model.pace;
    for (int k = 0; k < kMostSteps; ++k) {
      const double change = pace_change(pass.result);
      double step = std::clamp(change, -kLargestStep, kLargestStep);
      while (std::fabs(step) >= kGoodEnough && !go_on(pass, step, pace_of_maps)) step /= 2;
      if (std::fabs(step) < kGoodEnough)
        return at_pace(pass.model, pass.model.pace * std::exp(step));
    }
    return pass.model;
  }

 private:
  // False, and no change, where the model cannot be advanced.
  bool go_on(Pass& pass, double step, double& pace_of_maps) const {
    Pass next{at_pace(pass.model, pass.model.pace * std::exp(step)), pass.maps, {}};
    const bool far = !maps_reach(next.model.pace, pace_of_maps);
    if (far) next.maps = {};
    try {
      next.result = filter_fields(data_, next.model, rough_, next.maps);
    } catch (const std::runtime_error&) {
      return false;
    }
    if (far) pace_of_maps = next.model.pace;
    pass = std::move(next);
    return true;
  }

  // That of the model, or the most probable of some if it is far off.
  Pass first_pass() const {
    std::optional<Pass> best;
    std::string failure;
    const auto consider = [&](const FilterModel& model) {
      try {
        Pass pass = pass_of(model);
        if (!best || pass.result.deviance < best->result.deviance) best = std::move(pass);
      } catch (const std::runtime_error& error) {
        failure = error.what();
      }
    };
    std::vector<FilterModel> models{model_};
    if (!model_.hypothesis.parts.empty()) models.push_back(with_strengths(0, model_));
    for (const FilterModel& model : models) {
      consider(model);
      if (best && is_near(best->result)) return std::move(*best);
    }
    for (const FilterModel& model : models)
      for (const double pace : kSlower) consider(at_pace(model, pace));
    if (!best) throw std::runtime_error(failure);
    return std::move(*best);
  }

  // If strengths stay as they are.
  static double pace_change(const FilterResult& pass) { return screen(pass, {}, {}).pace_change; }

  static bool is_near(const FilterResult& pass) {
    constexpr double kFarGap = 2;  // measured minus forecast, over what noise makes of it
    return std::fabs(pace_change(pass)) < kLargestStep &&
           gaps_of_pass(pass).train < kFarGap * expected_gaps(pass).train;
  }

  Pass pass_of(const FilterModel& model) const {
    Pass pass{model, {}, {}};
    pass.result = filter_fields(data_, model, rough_, pass.maps);
    return pass;
  }

  const FilterProblems& data_;
  const FilterModel& model_;
  FilterSettings rough_;
};

}  // namespace

FilterModel with_first_pace(const FilterProblems& data, const FilterModel& model,
                            const FilterSettings& settings) {
  return PaceSearch(data, model, settings).run();
}

}  // namespace traceraft
