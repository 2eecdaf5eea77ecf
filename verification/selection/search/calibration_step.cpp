// Noise, D and strengths of a model, by forecasts that know the errors of states and of the mesh.
#include <cmath>
#include <stdexcept>

#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"
#include "verification/assimilation/fields/registration.hpp"
#include "verification/assimilation/filter/rest.hpp"
#include "verification/selection/fit/first_diffusion_ratio.hpp"
#include "verification/selection/fit/refit_unknowns.hpp"
#include "verification/selection/search/steps.hpp"

namespace traceraft::selection {
namespace {

// A refit that ends beyond kMapsReach is none of the noise and the errors that it began with.
constexpr int kMostPasses = 4;
// A correlation of noise that is not settled by then is near what it should be.
constexpr int kMostCorrelationPasses = 4;
// Strengths that a model cannot be advanced with are halved so often; then they are 0.
constexpr int kMostWeakenings = 3;

// A calibration that is not over.
struct Pass {
  Search& search;
  assimilation::FilterProblems& data;
  assimilation::FilterModel model;
  Forecasts forecasts = {};

  const assimilation::FilterSettings& settings() const { return search.request().filter; }
  ForecastPoint here() const {
    return {assimilation::noise_model(data), model.diffusion_ratio, model.hypothesis};
  }
};

assimilation::FilterResult forecast(Pass& pass) {
  pass.forecasts.maps_at = pass.here();
  pass.forecasts.maps = {};
  return assimilation::filter_fields(pass.data, pass.model, pass.settings(), pass.forecasts.maps);
}

// Weakens effects that the model has until it can be advanced.
assimilation::FilterResult forecast_weakened(Pass& pass) {
  for (int half = 0;; ++half) {
    try {
      return forecast(pass);
    } catch (const std::runtime_error& error) {
      if (pass.model.hypothesis.parts.empty() || half > kMostWeakenings) throw;
      pass.search.tell(std::string("  fails at the strengths that the model states: ") +
                       error.what());
    }
    pass.model = with_strengths(half < kMostWeakenings ? 0.5 : 0, pass.model);
  }
}

// The noise is that of the model, which begins with these forecasts; where neighbours share another
// part of it, forecasts are repeated with that.
void settle_noise(Pass& pass, assimilation::FilterResult forecasts) {
  const std::vector<assimilation::Candidate> screened = std::exchange(pass.model.screened, {});
  for (int k = 0;
       k <= kMostCorrelationPasses &&
       assimilation::fit_noise_covariance(pass.data, forecasts, pass.model.base, pass.settings());
       ++k) {
    pass.search.tell("  noise: " + assimilation::text_of(pass.data.front().correlation));
    forecasts = forecast(pass);
  }
  pass.model.screened = screened;
}

// Forecasts of the fields, with the responses to all candidates.
void screen_forecasts(Pass& pass) {
  pass.search.tell(formatted("  responses to %zu effects", pass.model.screened.size()));
  pass.forecasts.fields_at = pass.here();
  pass.forecasts.fields =
      assimilation::filter_fields(pass.data, pass.model, pass.settings(), pass.forecasts.maps);
}

// Returns whether the forecasts' errors are those of the fit, too.
bool refit_model(Pass& pass, SearchState& state, const char* what) {
  pass.search.tell(what);
  const double before = pass.model.diffusion_ratio;
  set_found(refit(pass.data, pass.model, pass.settings(), pass.forecasts.maps), state);
  pass.model = pass.search.model(state);
  return assimilation::maps_reach(pass.model.diffusion_ratio, before);
}

void calibrate_to_end(Pass& pass, SearchState& state) {
  bool settled = false;
  for (int k = 0; k < kMostPasses && !settled; ++k) {
    pass.search.tell(kForecastNews);
    settle_noise(pass, forecast(pass));
    settled = refit_model(pass, state, "  fit D and the effects");
  }
  screen_forecasts(pass);
  bootstrap(pass.forecasts.fields, pass.model, state.so_far.found);
}

// Strengths may go further than first orders reach; D does not.
void calibrate_base(Pass& pass, SearchState& state) {
  const bool own = !pass.search.request().own.parts.empty();
  bool settled = false;
  for (int k = 0; k < kMostPasses && !settled; ++k) {
    pass.search.tell(kForecastNews);
    settle_noise(pass, forecast_weakened(pass));
    if (!own) screen_forecasts(pass);
    settled = refit_model(pass, state, own ? "  fit D and the effects" : "  fit D");
    if (!settled)
      pass.search.tell(formatted("  D is %.2g times the model's", pass.model.diffusion_ratio));
  }
  if (own)
    calibrate_to_end(pass, state);
  else
    bootstrap(pass.forecasts.fields, pass.model, state.so_far.found);
  Explanation& result = state.so_far;
  result.disagreements = assimilation::disagreements(pass.data, pass.forecasts.fields,
                                                     pass.search.request().base.well);
  result.disagreements.resize(
      assimilation::significant(result.disagreements, pass.search.request().false_alarms));
  result.base = result.found;
}

// The state knows what the forecasts are of.
SearchState calibrated(Pass& pass, SearchState state) {
  state.so_far.noise_model = assimilation::noise_model(pass.data);
  state.so_far.noise = assimilation::noise_of(pass.data);
  state.maps_at = pass.forecasts.maps_at;
  state.fields_at = pass.forecasts.fields_at;
  pass.search.keep(std::move(pass.forecasts));
  return state;
}

// Nothing was looked at beside what was found.
SearchState stopped(SearchState state, const std::string& why) {
  Explanation& result = state.so_far;
  result.stopped = why;
  result.frames.clear();
  result.found_maps = {};
  state.next = SearchStep::confirm;
  if (result.found.hypothesis.added() > 0) return state;
  result.rivals.clear();
  result.finding = result.without_gap = Finding::not_identifiable;
  return state;
}

// Nothing is fitted: any D and any effect that leaves the rafts at rest would do. The round has
// looked for nothing.
SearchState at_rest(const Search& search, const assimilation::FilterProblems& data,
                    SearchState state) {
  search.tell("the rafts are at rest, and the model agrees: nothing tells how fast they change");
  const ExplainRequest& request = search.request();
  Explanation& result = state.so_far;
  result.at_rest = true;
  result.finding = result.without_gap = Finding::not_identifiable;
  result.noise = assimilation::noise_of(data);
  result.found.hypothesis = request.own;
  result.found.diffusion_ratio_deviation = std::numeric_limits<double>::infinity();
  result.found.settled = true;
  result.base = result.found;
  result.rounds.push_back({{request.base, 1, request.own, {}}, {}, result.found, {}, {}, {}});
  state.next = SearchStep::done;
  return state;
}

void describe_data(const Search& search, const assimilation::FilterProblems& data,
                   Explanation& result) {
  const ExplainRequest& request = search.request();
  result.noise_model = assimilation::noise_model(data);
  result.h_over_epsilon = search.h_over_epsilon();
  result.false_alarms = request.false_alarms;
  result.diffusion_ratio_doubt = request.filter.diffusion_ratio_doubt;
  for (const assimilation::FilterProblem& vesicle : data) result.outliers += vesicle.outliers;
}

}  // namespace

SearchState start(Search& search, SearchState state) {
  const ExplainRequest& request = search.request();
  Explanation& result = state.so_far;
  const assimilation::FilterProblems& data = search.data_at_start();
  describe_data(search, data, result);
  if (assimilation::are_at_rest(data, effects::with_effects(request.base, request.own.terms())))
    return at_rest(search, data, std::move(state));
  search.tell("fit D of the base model");
  const assimilation::FilterModel model =
      with_first_diffusion_ratio(data, {request.base, 1, request.own, {}}, request.filter);
  result.found.diffusion_ratio = model.diffusion_ratio;
  result.found.hypothesis = model.hypothesis;
  const bool far = std::fabs(std::log(model.diffusion_ratio)) > std::log(kFarDiffusionRatio);
  search.tell(formatted("  D is about %.2g times the model's%s", model.diffusion_ratio,
                        far ? "; are time_unit and the model's --diffusion right?" : ""));
  for (const assimilation::FilterProblem& vesicle : data)
    for (std::size_t k = 1; k < vesicle.turns.size(); ++k)
      if (vesicle.turns[k])
        result.registered.push_back(
            {vesicle.vesicle, k, assimilation::angle_of(vesicle.turns[k]->rotation)});
  state.next = SearchStep::calibrate;
  return state;
}

SearchState calibrate_found(Search& search, SearchState state) {
  Pass pass{search, search.data(state), search.model(state)};
  calibrate_to_end(pass, state);
  return calibrated(pass, std::move(state));
}

SearchState calibrate(Search& search, SearchState state) {
  const assimilation::Hypothesis& found = state.so_far.found.hypothesis;
  if (state.so_far.rounds.empty()) {
    search.tell("search for what is missing from the base model");
    Pass pass{search, search.data(state), search.model(state)};
    calibrate_base(pass, state);
    state.next = SearchStep::screen;
    return calibrated(pass, std::move(state));
  }
  search.tell("search for what is missing from the model with " + found.name());
  try {
    SearchState next = calibrate_found(search, state);
    next.next = SearchStep::eliminate;
    return next;
  } catch (const IoError&) {
    throw;
  } catch (const std::runtime_error& error) {
    return stopped(std::move(state), error.what());
  }
}

}  // namespace traceraft::selection
