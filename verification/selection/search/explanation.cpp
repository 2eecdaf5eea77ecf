#include "verification/selection/search/explanation.hpp"

#include <algorithm>
#include <utility>

#include "kernel/core/text.hpp"
#include "verification/selection/search/rerun.hpp"
#include "verification/selection/search/steps.hpp"

namespace traceraft::selection {
namespace {

// Is it the hypothesis, or that with something more?
bool has_found(const assimilation::Hypothesis& hypothesis, const assimilation::Hypothesis& found) {
  return std::all_of(found.parts.begin(), found.parts.end(),
                     [&](const auto& part) { return hypothesis.has(part.candidate.name); });
}

}  // namespace

std::optional<assimilation::Gaps> runner_up(const Explanation& result) {
  const Refit* best = nullptr;
  const auto consider = [&](const std::vector<Refit>& fits) {
    for (const Refit& fit : fits)
      if (!has_found(fit.hypothesis, result.found.hypothesis) &&
          !fit.hypothesis.contains(result.found.hypothesis) && fit.failure.empty() &&
          (best == nullptr || fit.gap.train < best->gap.train))
        best = &fit;
  };
  consider(result.rivals);
  for (auto round = result.rounds.rbegin(); round != result.rounds.rend() && best == nullptr;
       ++round) {
    consider(round->refits);
    consider(round->moves);
  }
  return best != nullptr ? std::optional(best->gap) : std::nullopt;
}

std::vector<Bound> bounds_of(const Explanation& found) {
  // Where the search had to stop nothing was looked for beside what was found.
  if (!found.stopped.empty() || found.rounds.empty()) return {};
  const Round& last = found.rounds.back();
  return bounds_of(last.screening, last.known.screened);
}

std::optional<double> closed_by_last_round(const Explanation& found) {
  if (found.rounds.empty()) return {};
  return shares_closed(found.rounds.back().without, found.found).train;
}

bool is_named(const Explanation& found) {
  return is_named(found.finding);
}

std::vector<std::string> class_of(const Explanation& found) {
  if (!is_named(found)) return {};
  std::vector<std::string> names{found.found.hypothesis.name()};
  for (const Refit& fit : found.rivals) names.push_back(fit.hypothesis.name());
  return names;
}

SearchState confirm(Search& search, SearchState state) {
  state.next = SearchStep::done;
  if (!search.request().confirm || !is_to_run_again(state.so_far)) return state;
  search.tell("check on another mesh, by another integrator");
  run_again(search.series(), search.request(), state.so_far);
  return state;
}

namespace {

SearchState after_step(Search& search, SearchState state) {
  switch (state.next) {
    case SearchStep::start:
      return start(search, std::move(state));
    case SearchStep::calibrate:
      return calibrate(search, std::move(state));
    case SearchStep::eliminate:
      return eliminate(search, std::move(state));
    case SearchStep::screen:
      return screen_candidates(search, std::move(state));
    case SearchStep::refit:
      return refit_shortlist(search, std::move(state));
    case SearchStep::choose:
      return choose(search, std::move(state));
    case SearchStep::replace:
      return replace(search, std::move(state));
    case SearchStep::compare_gaps:
      return compare_gaps(search, std::move(state));
    case SearchStep::weigh:
      return weigh(search, std::move(state));
    case SearchStep::confirm:
      return confirm(search, std::move(state));
    case SearchStep::done:
      return state;
  }
  return state;
}

}  // namespace

SearchState next_state(Search& search, SearchState state) {
  SearchState next = after_step(search, std::move(state));
  next.refits.clear();
  return next;
}

Explanation explain_fields(const std::vector<assimilation::FieldSeries>& series,
                           const ExplainRequest& request, SearchState from) {
  Search search(series, request);
  const bool coarse = search.h_over_epsilon() > kCoarse;
  search.tell(formatted("%d cells, h/epsilon = %.2f%s", request.cells, search.h_over_epsilon(),
                        coarse ? ": COARSE, choose more --cells" : ""));
  if (from.next != SearchStep::start) search.tell("continue from the saved state");
  SearchState state = std::move(from);
  while (state.next != SearchStep::done) {
    state = next_state(search, std::move(state));
    search.save(state);
  }
  const mesh::CutSurface& surface = search.data(state).front().space->surface;
  state.so_far.map_mesh = {surface.position, surface.triangles};
  return state.so_far;
}

}  // namespace traceraft::selection
