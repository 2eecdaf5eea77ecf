#include "verification/explain/search.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "verification/explain/noise_levels.hpp"

namespace traceraft {

Search::Search(const std::vector<FieldSeries>& series, const ExplainRequest& explain_request)
    : request(explain_request),
      data(problems_of(series, request)),
      candidates(candidates_for(request.base, *request.surface,
                                data.front().space->surface.position, request.without)),
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

FilterResult Search::first_pass() {
  fit_noise(data, filter_fields(data, model, request.filter, maps));
  FilterResult pass = filter_fields(data, model, request.filter, maps);
  result.disagreements = disagreements(data, pass, request.base.well);
  result.disagreements.resize(significant(result.disagreements, request.false_alarms));
  set_found(refit(data, model, request.filter, maps));
  bootstrap(pass, model, result.found);
  result.base = result.found;
  return pass;
}

FilterResult Search::next_pass() {
  maps = {};
  fit_noise(data, filter_fields(data, model, request.filter, maps));
  set_found(refit(data, model, request.filter, maps));
  FilterResult pass = filter_fields(data, model, request.filter, maps);
  bootstrap(pass, model, result.found);
  return pass;
}

std::vector<Refit> Search::refit_all(const std::vector<FilterModel>& trials) const {
  return refit_each(data, trials, request.filter, maps, [&](const Refit& fit) {
    // With one effect more there is nothing to lose.
    const bool more = fit.hypothesis.parts.size() > result.found.hypothesis.parts.size();
    const double difference = result.found.deviance - fit.deviance;
    const double gained = more ? std::max(0.0, difference) : difference;
    tell("  " + fit.hypothesis.name() +
         (fit.failure.empty() ? " gains " + std::to_string(std::lround(gained)) : " fails"));
  });
}

SearchState Search::state(bool more) const {
  SearchState now{result, {}, more, told_apart};
  for (const FilterProblem& vesicle : data) now.noise.push_back(vesicle.noise);
  return now;
}

void Search::go_on_from(const SearchState& state) {
  result = state.so_far;
  told_apart = state.told_apart;
  for (FilterProblem& vesicle : data) vesicle.noise = state.noise[vesicle.vesicle];
  set_found(result.found);
}

bool is_among(const std::vector<std::string>& hypotheses, const Refit& fit) {
  return std::find(hypotheses.begin(), hypotheses.end(), fit.hypothesis.name()) != hypotheses.end();
}

}  // namespace traceraft
