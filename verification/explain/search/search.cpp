#include "verification/explain/search/search.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/core/text.hpp"
#include "verification/explain/filter/noise_levels.hpp"
#include "verification/explain/fit/refit_unknowns.hpp"

namespace traceraft {
namespace {

// A refit that ends beyond kMapsReach is none of the noise and the errors that it began with.
constexpr int kMostPasses = 4;
// A correlation of noise that is not settled by then is near what it should be.
constexpr int kMostCorrelationPasses = 4;
// Of strengths that a model cannot be advanced with; then they are 0.
constexpr int kMostHalvings = 3;

}  // namespace

Search::Search(const std::vector<FieldSeries>& series, const ExplainRequest& explain_request)
    : request(explain_request),
      data(problems_of(series, request)),
      candidates(candidates_beside(
          request.own, candidates_for(request.base, *request.surface,
                                      data.front().space->surface.position, request.without))),
      model{request.base, 1, {}, candidates} {}

void Search::tell(const std::string& step) const {
  if (request.progress) request.progress(step);
}

void Search::set_found(const Refit& fit) {
  if (!fit.failure.empty()) throw std::runtime_error(fit.failure);
  result.found = fit;
  model.hypothesis = fit.hypothesis;
  model.pace = fit.pace;
  model.screened.clear();
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(model.screened),
               [&](const Candidate& c) { return !fit.hypothesis.has(c.effect); });
}

FilterResult Search::pass_with_own_effects() {
  for (int half = 0;; ++half) {
    maps = {};
    try {
      return filter_fields(data, model, request.filter, maps);
    } catch (const std::runtime_error& error) {
      if (model.hypothesis.parts.empty() || half > kMostHalvings) throw;
      tell(std::string("  fails with effects as strong as the model has them: ") + error.what());
    }
    model = with_strengths(half < kMostHalvings ? 0.5 : 0, model);
  }
}

void Search::settle_noise(FilterResult pass) {
  FilterModel bare = model;
  bare.screened.clear();
  for (int k = 0; fit_noise_covariance(data, pass, request.base, request.filter); ++k) {
    tell("  noise: " + text_of(data.front().correlation));
    maps = {};
    if (k == kMostCorrelationPasses) return;
    pass = filter_fields(data, bare, request.filter, maps);
  }
}

FilterResult Search::first_pass() {
  FilterResult pass;
  for (int k = 0; k < kMostPasses; ++k) {
    const double pace = model.pace;
    tell("  forecasts, and errors of states and of the mesh");
    settle_noise(pass_with_own_effects());
    if (request.own.parts.empty()) {
      tell(formatted("  what %zu effects would change", model.screened.size()));
      pass = filter_fields(data, model, request.filter, maps);
    }
    tell(request.own.parts.empty() ? "  D" : "  D, and its effects");
    set_found(refit(data, model, request.filter, maps));
    if (maps_reach(result.found.pace, pace)) break;
    tell(formatted("  D is rather %.2g times the model's", result.found.pace));
  }
  // Strengths may have gone further than first orders reach; D has not.
  if (request.own.parts.empty())
    bootstrap(pass, model, result.found);
  else
    pass = next_pass();
  result.disagreements = disagreements(data, pass, request.base.well);
  result.disagreements.resize(significant(result.disagreements, request.false_alarms));
  result.base = result.found;
  return pass;
}

FilterResult Search::next_pass() {
  for (int k = 0; k < kMostPasses; ++k) {
    const double pace = model.pace;
    maps = {};
    tell("  forecasts, and errors of states and of the mesh");
    settle_noise(filter_fields(data, model, request.filter, maps));
    tell("  D, and its effects");
    set_found(refit(data, model, request.filter, maps));
    if (maps_reach(result.found.pace, pace)) break;
  }
  tell(formatted("  what %zu effects would change", model.screened.size()));
  FilterResult pass = filter_fields(data, model, request.filter, maps);
  bootstrap(pass, model, result.found);
  return pass;
}

std::vector<Refit> Search::refit_all(const std::vector<FilterModel>& trials) {
  const std::size_t first = numbered_;
  numbered_ += trials.size();
  std::map<std::size_t, Refit>& ahead = before_.ahead;
  std::vector<std::size_t> open;
  std::vector<FilterModel> open_trials;
  for (std::size_t k = first; k < numbered_; ++k) {
    const auto known = ahead.find(k);
    if (known != ahead.end() &&
        known->second.hypothesis.name() == trials[k - first].hypothesis.name()) {
      tell_gain(known->second);
      continue;
    }
    open.push_back(k);
    open_trials.push_back(trials[k - first]);
  }
  refit_each(data, open_trials, request.filter, maps, [&](std::size_t which, const Refit& fit) {
    tell_gain(fit);
    ahead[open[which]] = fit;
    save(before_);
  });
  std::vector<Refit> refits;
  for (std::size_t k = first; k < numbered_; ++k) refits.push_back(ahead.at(k));
  return refits;
}

void Search::tell_gain(const Refit& fit) const {
  // With one effect more there is nothing to lose.
  const bool more = fit.hypothesis.added() > result.found.hypothesis.added();
  const double difference = result.found.deviance - fit.deviance;
  const double gained = more ? std::max(0.0, difference) : difference;
  const std::string change = (gained < 0 ? std::string(" loses ") : std::string(" gains ")) +
                             std::to_string(std::labs(std::lround(gained)));
  const std::string name = fit.hypothesis.added() == 0 ? "no effect" : fit.hypothesis.name();
  tell("  " + name + (fit.failure.empty() ? change : " fails"));
}

SearchState Search::state(bool more) const {
  SearchState now{result, {}, {}, more, told_apart, {}};
  for (const FilterProblem& vesicle : data) now.noise.push_back(vesicle.noise);
  now.correlation = data.front().correlation;
  return now;
}

void Search::save(const SearchState& state) const {
  if (request.save) request.save(state);
}

void Search::begin_round(bool more, std::map<std::size_t, Refit> ahead) {
  before_ = state(more);
  before_.ahead = std::move(ahead);
  numbered_ = 0;
  save(before_);
}

void Search::go_on_from(const SearchState& state) {
  result = state.so_far;
  told_apart = state.told_apart;
  give_noise(state.noise, state.correlation, request.base, request.filter, data);
  set_found(result.found);
}

bool is_among(const std::vector<std::string>& hypotheses, const Refit& fit) {
  return std::find(hypotheses.begin(), hypotheses.end(), fit.hypothesis.name()) != hypotheses.end();
}

}  // namespace traceraft
