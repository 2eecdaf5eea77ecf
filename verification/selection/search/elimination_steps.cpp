// Hypotheses near the one that was found: without one of its effects, or with another in its place.
#include <algorithm>
#include <iterator>

#include "kernel/core/text.hpp"
#include "verification/selection/search/neighbours.hpp"
#include "verification/selection/search/steps.hpp"

namespace traceraft::selection {
namespace {

// Effects that are replaced at once.
constexpr int kMostReplacements = 3;

assimilation::Hypothesis without(assimilation::Hypothesis hypothesis, const std::string& effect) {
  auto& parts = hypothesis.parts;
  parts.erase(std::remove_if(parts.begin(), parts.end(),
                             [&](const auto& part) { return part.candidate.name == effect; }),
              parts.end());
  return hypothesis;
}

std::vector<std::string> unresolved(const Refit& found, double values, double mesh_error) {
  std::vector<std::string> effects;
  for (std::size_t k = found.hypothesis.known; k < found.hypothesis.parts.size(); ++k)
    if (!resolved(found, k, values, mesh_error))
      effects.push_back(found.hypothesis.parts[k].candidate.name);
  return effects;
}

// The most probable one without an effect, by its number; none if that is not more probable.
std::optional<std::size_t> best_without(const std::vector<Refit>& fits, const Refit& found,
                                        double values) {
  std::optional<std::size_t> best;
  double least = criterion(found, values);
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (!fits[k].failure.empty() || criterion(fits[k], values) > least) continue;
    least = criterion(fits[k], values);
    best = k;
  }
  return best;
}

std::vector<assimilation::FilterModel> rivals_without_dropped(const Search& search,
                                                              const SearchState& state) {
  const Explanation& result = state.so_far;
  std::vector<assimilation::FilterModel> trials;
  std::vector<std::string> tried{result.found.hypothesis.name()};
  for (const Refit& rival : result.rivals) {
    assimilation::FilterModel trial = search.model(state);
    trial.hypothesis = rival.hypothesis;
    trial.diffusion_ratio = rival.diffusion_ratio;
    for (const ModelChange& change : result.changes)
      if (change.reason == ModelChange::is_none)
        trial.hypothesis = without(trial.hypothesis, change.from);
    const std::string name = trial.hypothesis.name();
    if (name.empty() || std::count(tried.begin(), tried.end(), name) > 0) continue;
    tried.push_back(name);
    trials.push_back(std::move(trial));
  }
  return trials;
}

// Null: none is better than what was found.
const Refit* better_one(const Search& search, const SearchState& state,
                        const std::vector<Refit>& fits) {
  const Refit* best = &state.so_far.found;
  for (const Refit& fit : fits)
    if (fit.failure.empty() &&
        criterion(fit, search.values()) < criterion(*best, search.values()) &&
        all_resolved(fit, search.values(), mesh_error(state)))
      best = &fit;
  return best == &state.so_far.found ? nullptr : best;
}

void add_rivals(const std::vector<Refit>& fits, double values, double limit, Explanation& result) {
  for (const Refit& fit : fits)
    if (fit.failure.empty() && explains_as_well(fit, result.found, values, limit) &&
        fit.hypothesis.parts.size() == result.found.hypothesis.parts.size() &&
        !is_among(class_of(result), fit))
      result.rivals.push_back(fit);
}

std::vector<assimilation::FilterModel> trials_near(const Search& search, const SearchState& state) {
  std::vector<assimilation::Candidate> open;
  const std::vector<assimilation::Candidate>& all = search.candidates();
  std::copy_if(
      all.begin(), all.end(), std::back_inserter(open),
      [&](const assimilation::Candidate& c) { return !was_dropped(state.so_far, c.name); });
  std::vector<assimilation::FilterModel> trials;
  for (assimilation::Hypothesis& near :
       neighbours(state.so_far.found, state.so_far.rounds, search.values(), open)) {
    trials.push_back(search.model(state));
    trials.back().hypothesis = std::move(near);
  }
  return trials;
}

}  // namespace

SearchState eliminate(Search& search, SearchState state) {
  const Refit found = state.so_far.found;
  const double values = search.values(),
               error = screen(search.forecasts(state).fields, {}, found.hypothesis).mesh_error;
  const std::vector<std::string> doubtful = unresolved(found, values, error);
  std::vector<assimilation::FilterModel> trials(doubtful.size(), search.model(state));
  for (std::size_t k = 0; k < trials.size(); ++k)
    trials[k].hypothesis = without(found.hypothesis, doubtful[k]);
  if (!trials.empty()) search.tell("without " + joined(doubtful, ", or without "));
  const std::vector<Refit> fits = search.refit_all(state, trials);
  const std::optional<std::size_t> best = best_without(fits, found, values);
  // Held-out snapshots may show that the effect is there.
  if (best && is_as_probable(search, state, fits[*best], found)) {
    search.tell("  " + doubtful[*best] + " is not significant");
    state.so_far.changes.push_back(
        {ModelChange::is_none, doubtful[*best], fits[*best].hypothesis.name()});
    set_found(fits[*best], state);
    state.eliminated = true;
    state.next = SearchStep::calibrate;
    return state;
  }
  if (state.eliminated) {
    std::vector<Refit> rivals;
    for (Refit& fit : search.refit_all(state, rivals_without_dropped(search, state), trials.size()))
      if (fit.failure.empty() &&
          explains_as_well(fit, found, values, discrimination_limit(values, error)))
        rivals.push_back(std::move(fit));
    state.so_far.rivals = std::move(rivals);
    state.so_far.finding = finding_beside(state.so_far.rivals.size());
  }
  state.next = SearchStep::screen;
  return state;
}

SearchState replace(Search& search, SearchState state) {
  Explanation& result = state.so_far;
  state.next = SearchStep::calibrate;
  if (result.found.hypothesis.added() <= 1 && state.replacements == 0) {
    result.finding = finding_beside(result.rivals.size());
    return state;
  }
  search.tell("replace " + result.found.hypothesis.name());
  const std::vector<Refit> fits = search.refit_all(state, trials_near(search, state));
  Round& round = result.rounds.back();
  for (const Refit& fit : fits)
    if (fit.failure.empty())
      round.moves.push_back(fit);
    else
      round.failures.push_back({fit.hypothesis.name(), fit.failure});
  const Refit* best =
      state.replacements < kMostReplacements ? better_one(search, state, fits) : nullptr;
  if (best == nullptr) {
    add_rivals(fits, search.values(), discrimination_limit(search.values(), mesh_error(state)),
               result);
    result.finding = finding_beside(result.rivals.size());
    return state;
  }
  result.changes.push_back(
      {ModelChange::replaced, result.found.hypothesis.name(), best->hypothesis.name()});
  set_found(*best, state);
  result.rivals.clear();
  ++state.replacements;
  state.next = SearchStep::replace;
  return state;
}

}  // namespace traceraft::selection
