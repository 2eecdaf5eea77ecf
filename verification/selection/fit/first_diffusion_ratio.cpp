#include "verification/selection/fit/first_diffusion_ratio.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "verification/assimilation/filter/gaps.hpp"
#include "verification/selection/fit/refit_unknowns.hpp"
#include "verification/selection/fit/score_test.hpp"

namespace traceraft::selection {
namespace {

constexpr int kRank = 80, kTangentSteps = 2, kMostSteps = 40;
// Steps of ln D: the largest one of a pass, and the one below which the rest is left to other
// searches.
constexpr double kLargestStep = 0.7, kGoodEnough = 0.02;
// A forecast of far too slow a membrane is about what was measured before, and its derivatives tell
// the way to the right diffusion ratio. Of far too fast a one everything has come to rest, and they
// tell nothing: such a search begins at one of these.
constexpr double kSlower[] = {1.0 / 8, 1.0 / 64, 1.0 / 512};

struct RoughPass {
  assimilation::FilterModel model;
  std::vector<assimilation::ErrorMaps> maps;
  assimilation::FilterResult result;
};

class DiffusionRatioSearch {
 public:
  DiffusionRatioSearch(const assimilation::FilterProblems& data,
                       const assimilation::FilterModel& model,
                       const assimilation::FilterSettings& settings)
      : data_(data), model_(model), rough_(settings) {
    rough_.rank = kRank;
    rough_.replicates = 0;
    rough_.tangent_steps = kTangentSteps;
  }

  assimilation::FilterModel run() const {
    RoughPass pass = first_pass();
    double diffusion_ratio_of_maps = pass.model.diffusion_ratio;
    for (int k = 0; k < kMostSteps; ++k) {
      const double change = diffusion_ratio_change(pass.result);
      double step = std::clamp(change, -kLargestStep, kLargestStep);
      while (std::fabs(step) >= kGoodEnough && !go_on(pass, step, diffusion_ratio_of_maps))
        step /= 2;
      if (std::fabs(step) < kGoodEnough)
        return at_diffusion_ratio(pass.model, pass.model.diffusion_ratio * std::exp(step));
    }
    return pass.model;
  }

 private:
  // False, and no change, where the model cannot be advanced.
  bool go_on(RoughPass& pass, double step, double& diffusion_ratio_of_maps) const {
    RoughPass next{
        at_diffusion_ratio(pass.model, pass.model.diffusion_ratio * std::exp(step)), pass.maps, {}};
    const bool far = !assimilation::maps_reach(next.model.diffusion_ratio, diffusion_ratio_of_maps);
    if (far) next.maps = {};
    try {
      next.result = assimilation::filter_fields(data_, next.model, rough_, next.maps);
    } catch (const std::runtime_error&) {
      return false;
    }
    if (far) diffusion_ratio_of_maps = next.model.diffusion_ratio;
    pass = std::move(next);
    return true;
  }

  // The pass of the model, or the most probable of some if it is far off.
  RoughPass first_pass() const {
    std::optional<RoughPass> best;
    std::string failure;
    const auto consider = [&](const assimilation::FilterModel& model) {
      try {
        RoughPass pass = pass_of(model);
        if (!best || pass.result.deviance < best->result.deviance) best = std::move(pass);
      } catch (const std::runtime_error& error) {
        failure = error.what();
      }
    };
    std::vector<assimilation::FilterModel> models{model_};
    if (!model_.hypothesis.parts.empty()) models.push_back(with_strengths(0, model_));
    for (const assimilation::FilterModel& model : models) {
      consider(model);
      if (best && is_near(best->result)) return std::move(*best);
    }
    for (const assimilation::FilterModel& model : models)
      for (const double diffusion_ratio : kSlower)
        consider(at_diffusion_ratio(model, diffusion_ratio));
    if (!best) throw std::runtime_error(failure);
    return std::move(*best);
  }

  // If strengths stay as they are.
  static double diffusion_ratio_change(const assimilation::FilterResult& pass) {
    return screen(pass, {}, {}).diffusion_ratio_change;
  }

  static bool is_near(const assimilation::FilterResult& pass) {
    constexpr double kFarGap = 2;  // measured minus forecast, over what noise makes of it
    return std::fabs(diffusion_ratio_change(pass)) < kLargestStep &&
           assimilation::gaps_of_pass(pass).train <
               kFarGap * assimilation::expected_gaps(pass).train;
  }

  RoughPass pass_of(const assimilation::FilterModel& model) const {
    RoughPass pass{model, {}, {}};
    pass.result = assimilation::filter_fields(data_, model, rough_, pass.maps);
    return pass;
  }

  const assimilation::FilterProblems& data_;
  const assimilation::FilterModel& model_;
  assimilation::FilterSettings rough_;
};

}  // namespace

assimilation::FilterModel with_first_diffusion_ratio(const assimilation::FilterProblems& data,
                                                     const assimilation::FilterModel& model,
                                                     const assimilation::FilterSettings& settings) {
  return DiffusionRatioSearch(data, model, settings).run();
}

}  // namespace traceraft::selection
