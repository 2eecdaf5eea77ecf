#include "verification/explain/search/explanation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/core/text.hpp"
#include "verification/explain/fields/registration.hpp"
#include "verification/explain/filter/noise_levels.hpp"
#include "verification/explain/fit/first_pace.hpp"
#include "verification/explain/search/class_evidence.hpp"
#include "verification/explain/search/search_round.hpp"

namespace traceraft {
namespace {

void start(Search& search) {
  search.tell("pace of the base model");
  const FilterModel model = with_first_pace(
      search.data, {search.request.base, 1, search.request.own, {}}, search.request.filter);
  Refit base;
  base.pace = model.pace;
  base.hypothesis = model.hypothesis;
  search.set_found(base);
  const bool far = std::fabs(std::log(base.pace)) > std::log(kFarPace);
  search.tell(formatted("  D is about %.2g times the model's%s", base.pace,
                        far ? ": are time_unit and the model's --diffusion right?" : ""));
}

// What was found, or that with something more?
bool has_found(const Hypothesis& hypothesis, const Hypothesis& found) {
  return std::all_of(found.parts.begin(), found.parts.end(),
                     [&](const auto& part) { return hypothesis.has(part.candidate.effect); });
}

Explanation conclusion(Search search) {
  Explanation& result = search.result;
  const ExplainRequest& request = search.request;
  const CutSurface& surface = search.data.front().space->surface;
  result.noise = noise_of(search.data);
  result.correlation = search.data.front().correlation;
  for (const FilterProblem& vesicle : search.data) {
    result.outliers += vesicle.outliers;
    result.noises.push_back(vesicle.noise);
    for (std::size_t k = 1; k < vesicle.turns.size(); ++k)
      if (vesicle.turns[k])
        result.registered.push_back({vesicle.vesicle, k, angle_of(vesicle.turns[k]->rotation)});
  }
  result.map_mesh = {surface.position, surface.triangles};
  result.replicates = request.filter.replicates;
  result.false_alarms = request.false_alarms;
  result.blur_stated = request.blur_stated;
  result.pace_doubt = request.filter.pace_doubt;
  result.h_over_epsilon = search.h_over_epsilon();
  result.base_gap = result.base.gap;
  result.found_gap = result.found.gap;
  result.placebo_gap = placebo_of(result);
  result.floor = result.found.expected;
  // Beside what was found; where the search had to stop nothing was looked for beside it.
  if (result.stopped.empty())
    result.bounds = bounds_of(result.rounds.back().screening, search.model.screened);
  return std::move(result);
}

}  // namespace

std::optional<Gaps> placebo_of(const Explanation& result) {
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

std::optional<double> closed_by_last_round(const Explanation& found) {
  if (found.rounds.empty()) return {};
  const Gaps& before = found.rounds.back().without.gap;
  return share_closed(before.train, found.found.gap.train, found.found.expected.train);
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

FilterProblems problems_of(const std::vector<FieldSeries>& series, const ExplainRequest& request) {
  return make_filter_problems(series, *request.surface, request.base, request.cells,
                              request.threads, request.hold_out, request.filter);
}

Explanation explain_fields(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                           const std::optional<SearchState>& saved) {
  Search search(series, request);
  const bool coarse = search.h_over_epsilon() > kCoarse;
  search.tell(formatted("%d cells, h/epsilon = %.2f%s", request.cells, search.h_over_epsilon(),
                        coarse ? ": COARSE, more --cells would say more" : ""));
  if (saved) {
    search.tell("what was found before");
    search.go_on_from(*saved);
  } else {
    start(search);
  }
  bool more = saved ? saved->more : true;
  auto ahead = saved ? saved->ahead : std::map<std::size_t, Refit>();
  while (more || !search.told_apart) {
    search.begin_round(more, std::exchange(ahead, {}));
    more = more ? look_for_one(search) : tell_apart(search);
  }
  search.save(search.state(more));
  return conclusion(std::move(search));
}

}  // namespace traceraft
