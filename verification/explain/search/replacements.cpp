#include "verification/explain/search/replacements.hpp"

#include <algorithm>
#include <iterator>

#include "verification/explain/search/drops.hpp"
#include "verification/explain/search/neighbours.hpp"

namespace traceraft {
namespace {

// Effects that are replaced or dropped at once.
constexpr int kMostMoves = 3;

// Effects that may be taken.
std::vector<Candidate> open_candidates(const Search& search) {
  std::vector<Candidate> open;
  std::copy_if(search.candidates.begin(), search.candidates.end(), std::back_inserter(open),
               [&](const Candidate& c) { return !was_dropped(search.result, c.effect); });
  return open;
}

std::vector<Refit> refit_neighbours(Search& search) {
  search.tell("in place of " + search.model.hypothesis.name());
  std::vector<FilterModel> trials;
  for (Hypothesis& near : neighbours(search.result.found, search.result.rounds, search.values(),
                                     open_candidates(search))) {
    trials.push_back(search.model);
    trials.back().hypothesis = std::move(near);
  }
  return search.refit_all(trials);
}

// Null: none is better than what was found.
const Refit* better_one(const Search& search, const std::vector<Refit>& fits) {
  const Refit* best = &search.result.found;
  for (const Refit& fit : fits)
    if (fit.failure.empty() &&
        criterion(fit, search.values()) < criterion(*best, search.values()) &&
        all_resolved(fit, search.values(), search.mesh_error()))
      best = &fit;
  return best == &search.result.found ? nullptr : best;
}

void add_rivals(Search& search, const std::vector<Refit>& fits) {
  Explanation& result = search.result;
  const double limit = telling(search.values(), search.mesh_error());
  for (const Refit& fit : fits)
    if (fit.failure.empty() && explains_as_well(fit, result.found, search.values(), limit) &&
        fit.hypothesis.parts.size() == result.found.hypothesis.parts.size() &&
        !is_among(class_of(result), fit))
      result.rivals.push_back(fit);
}

}  // namespace

void improve(Search& search) {
  Explanation& result = search.result;
  for (int move = 0; result.found.hypothesis.added() > 1 || move > 0; ++move) {
    const std::vector<Refit> fits = refit_neighbours(search);
    Round& round = result.rounds.back();
    for (const Refit& fit : fits)
      if (fit.failure.empty())
        round.moves.push_back(fit);
      else
        round.failures.push_back({fit.hypothesis.name(), fit.failure});
    const Refit* best = move < kMostMoves ? better_one(search, fits) : nullptr;
    if (best == nullptr) {
      add_rivals(search, fits);
      break;
    }
    result.turns.push_back(
        {Turn::replaced, result.found.hypothesis.name(), best->hypothesis.name()});
    search.set_found(*best);
    result.rivals.clear();
  }
  result.finding = result.rivals.empty() ? Finding::named : Finding::ambiguous;
}

}  // namespace traceraft
