#include "drivers/explain/series_ensembles.hpp"

#include <algorithm>

#include "backends/posix/process.hpp"
#include "drivers/ensemble/ensemble_folder.hpp"
#include "drivers/explain/found_parameters.hpp"
#include "drivers/input/measured_units.hpp"
#include "drivers/numerical_failure.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "verification/assimilation/forecast/candidates.hpp"

namespace traceraft::explain {
namespace {

namespace fs = std::filesystem;

// The fastest D over that of the model: runs last as long as if it were that.
constexpr double kFastestDiffusionRatio = 4;

void tell(const SeriesEnsemblesRequest& request, const std::string& step) {
  if (request.quiet) return;
  text::say("%s\n", step);
  text::flush_output();
}

// "asymmetry, strength 0.0256"
std::string label_of(const effects::EffectTerm& term, std::size_t sought,
                     const physics::Units& units) {
  const FoundParameter strength = parameters_of(term, units)[sought];
  return term.effect + ", " + strength.name + formatted(" %.3g", strength.value) +
         (strength.unit.empty() ? "" : " " + strength.unit);
}

[[noreturn]] void fail(const std::vector<ensemble::MemberFailure>& failures) {
  throw drivers::NumericalFailure("the run of seed " + std::to_string(failures.front().seed) +
                                  " failed: " + failures.front().why);
}

class EnsembleSimulations {
 public:
  EnsembleSimulations(const fs::path& folder, const config::Configuration& model,
                      const SeriesEnsemblesRequest& request)
      : folder_(folder), model_(model), request_(request), units_(model.units()) {}

  // A few vesicles, to find out what a strength does.
  ensemble::PointEnd try_out(const std::string& name, const effects::EffectTerm* term) const {
    constexpr int kRuns = 4;
    const std::string effect = term == nullptr ? "" : effect_text({*term}, units_);
    return ensemble::run_point(folder_ / "trials" / name,
                               ensemble_model(model_, effect, request_.looks.end),
                               {kRuns, request_.jobs, request_.quiet});
  }

  SeriesEnsembles run(std::vector<PlannedEffect> plan) const {
    SeriesEnsembles result;
    result.folder = fs::absolute(folder_).lexically_normal();
    result.kelvin = request_.kelvin;
    tell(request_, "simulations with no effect");
    ensemble::PointEnd base = simulate("base", "");
    if (!base.failures.empty()) fail(base.failures);
    result.base = std::move(base.runs);
    result.stopped = base.stopped;
    for (std::size_t k = 0; k < plan.size() && !result.stopped; ++k) {
      tell(request_, formatted("simulations with effect %zu of %zu", k + 1, plan.size()));
      add(plan[k], result);
    }
    return result;
  }

 private:
  ensemble::PointEnd simulate(const std::string& name, const std::string& effect) const {
    return ensemble::run_point(
        folder_ / name, ensemble_model(model_, effect, kFastestDiffusionRatio * request_.looks.end),
        {request_.runs, request_.jobs, request_.quiet});
  }

  // An effect whose runs fail is left out.
  void add(PlannedEffect& planned, SeriesEnsembles& result) const {
    const ParameterSpec& spec =
        effects::effects().find(planned.effect()).parameters[planned.sought()];
    selection::SeriesCandidate candidate{
        planned.effect(), {}, assimilation::find_candidate(planned.effect())->two_sided};
    candidate.rate = effects::is_rate(spec.unit) || planned.levels.size() > 1;
    candidate.typical = planned.typical;
    for (std::size_t k = 0; k < planned.levels.size(); ++k) {
      effects::EffectTerm& term = planned.levels[k];
      term = within_range(term, planned.sought(), units_);
      tell(request_, "  " + label_of(term, planned.sought(), units_));
      const std::string name =
          planned.effect() + (planned.levels.size() == 1 ? "" : formatted("-%zu", k + 1));
      ensemble::PointEnd end = simulate(name, effect_text({term}, units_));
      result.stopped = end.stopped;
      if (end.stopped) return;
      if (!end.failures.empty()) {
        result.notes.push_back(planned.effect() + " is left out, because the run of seed " +
                               std::to_string(end.failures.front().seed) +
                               " failed: " + end.failures.front().why);
        return;
      }
      candidate.levels.push_back({planned.strength(k), std::move(end.runs)});
    }
    result.candidates.push_back(std::move(candidate));
    result.effects.push_back(planned);
  }

  const fs::path folder_;
  const config::Configuration& model_;
  const SeriesEnsemblesRequest& request_;
  const physics::Units units_;
};

}  // namespace

effects::EffectTerm within_range(effects::EffectTerm term, std::size_t parameter,
                                 const physics::Units& units) {
  const ParameterSpec& spec = effects::effects().find(term.effect).parameters[parameter];
  const double factor = effects::to_model_units(spec.unit, units);
  term.values[parameter] = std::clamp(term.values[parameter], factor * spec.min, factor * spec.max);
  return term;
}

void take_over_ensembles(const fs::path& folder, const config::Configuration& model,
                         SeriesEnsemblesRequest& request) {
  const ensemble::EnsembleFolder base(folder / "base");
  if (!has_plan(folder) || !base.started())
    throw InputError(
        "--ensembles: " + folder.string() +
        " holds no simulations; the folder 'ensembles' of an earlier search is needed");
  request.runs = base.load().runs;
  request.looks = planned_looks(folder, model);
}

std::string note_on_looks(const statistics::Window& simulated, const statistics::Window& measured) {
  constexpr double kFar = 3;
  if (measured.end < kFar * simulated.end && measured.end > simulated.end / kFar) return "";
  return formatted(
      "The strengths of the effects were chosen for observations from %.3g to %.3g s, but the "
      "measurements are from %.3g to %.3g s.",
      simulated.begin, simulated.end, measured.begin, measured.end);
}

void refuse_series(const observations::MeasuredVesicles& data, const config::Configuration& model) {
  input::refuse_scaled(model);
  if (model.options().surface != "sphere")
    throw InputError(model.where(&config::RunOptions::surface) +
                     ": series can be explained on spheres only");
  if (!model.options().effect.empty())
    throw InputError(model.where(&config::RunOptions::effect) +
                     ": series need a model without effects; the search adds one effect at a time");
  ensemble::refuse_without_noise(model);
  selection::refuse_vesicles(data);
  if (const statistics::Window window = observations::looks(data); !(window.begin < window.end))
    throw InputError("series: observations at two or more times are needed");
}

SeriesEnsembles run_series_ensembles(const fs::path& folder, const config::Configuration& model,
                                     const SeriesEnsemblesRequest& request) {
  fs::create_directories(folder);
  const EnsembleSimulations simulations(folder, model, request);
  const bool discs = run::is_of_discs(model);
  // The sizes of fields take one process, which a signal may end.
  if (discs) posix::catch_stop_signals();
  std::optional<std::vector<PlannedEffect>> plan =
      plan_effects(folder, model,
                   {request.looks, request.threads, request.without, request.kelvin,
                    [&](const std::string& name, const effects::EffectTerm* term) {
                      return simulations.try_out(name, term);
                    },
                    [&](const std::string& step) { tell(request, step); }});
  posix::catch_stop_signals();
  SeriesEnsembles stopped;
  stopped.stopped = true;
  return plan ? simulations.run(std::move(*plan)) : stopped;
}

}  // namespace traceraft::explain
