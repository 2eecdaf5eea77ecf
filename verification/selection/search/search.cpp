#include "verification/selection/search/search.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "verification/assimilation/filter/random_motion.hpp"

namespace traceraft::selection {
namespace {

bool same_hypothesis(const assimilation::Hypothesis& a, const assimilation::Hypothesis& b) {
  return a.known == b.known &&
         std::equal(
             a.parts.begin(), a.parts.end(), b.parts.begin(), b.parts.end(),
             [](const assimilation::Hypothesis::Part& p, const assimilation::Hypothesis::Part& q) {
               return p.candidate.name == q.candidate.name && p.coefficients == q.coefficients;
             });
}

std::string news_of(const Refit& fit, const Refit& found) {
  const std::string name = fit.hypothesis.added() == 0 ? "no effect" : fit.hypothesis.name();
  if (!fit.failure.empty()) return "  " + name + " fails";
  // One effect more cannot lose anything.
  const bool more = fit.hypothesis.added() > found.hypothesis.added();
  const double difference = found.deviance - fit.deviance;
  const double gained = more ? std::max(0.0, difference) : difference;
  return "  " + name + (gained < 0 ? " loses " : " gains ") +
         std::to_string(std::labs(std::lround(gained)));
}

}  // namespace

std::string word_for(SearchStep step) {
  for (const auto& [known, word] : kSearchSteps)
    if (known == step) return word;
  return "";
}

bool operator==(const ForecastPoint& a, const ForecastPoint& b) {
  return a.diffusion_ratio == b.diffusion_ratio && same_hypothesis(a.hypothesis, b.hypothesis) &&
         a.noise == b.noise;
}

assimilation::FilterProblems problems_of(const std::vector<assimilation::FieldSeries>& series,
                                         const ExplainRequest& request) {
  return assimilation::make_filter_problems(series, request.surface, request.base, request.cells,
                                            request.threads, request.hold_out, request.filter);
}

Search::Search(const std::vector<assimilation::FieldSeries>& series, const ExplainRequest& request)
    : series_(series),
      request_(request),
      data_(problems_of(series, request)),
      candidates_(assimilation::candidates_beside(
          request.own,
          assimilation::candidates_for(request.base, *request.surface,
                                       data_.front().space->surface.position, request.without))) {
  std::vector<assimilation::Candidate> all = candidates_;
  for (const assimilation::Hypothesis::Part& part : request.own.parts)
    all.push_back(part.candidate);
  assimilation::set_random_effects(all, request.base, data_);
}

void Search::tell(const std::string& news) const {
  if (request_.progress) request_.progress(news);
}

void Search::save(const SearchState& state) const {
  if (request_.save) request_.save(state);
}

assimilation::FilterProblems& Search::data(const SearchState& state) {
  if (!(assimilation::noise_model(data_) == state.so_far.noise_model))
    assimilation::set_noise_model(state.so_far.noise_model, request_.base, request_.filter, data_);
  return data_;
}

assimilation::FilterModel Search::model(const SearchState& state) const {
  const Refit& found = state.so_far.found;
  assimilation::FilterModel model{request_.base, found.diffusion_ratio, found.hypothesis, {}};
  std::copy_if(candidates_.begin(), candidates_.end(), std::back_inserter(model.screened),
               [&](const assimilation::Candidate& c) { return !found.hypothesis.has(c.name); });
  return model;
}

const Forecasts& Search::forecasts(const SearchState& state) {
  if (forecasts_.maps_at == state.maps_at && forecasts_.fields_at == state.fields_at)
    return forecasts_;
  tell(kForecastNews);
  forecasts_ = {};
  Forecasts again{state.maps_at, state.fields_at, {}, {}};
  assimilation::set_noise_model(again.maps_at.noise, request_.base, request_.filter, data_);
  const ForecastPoint& maps_at = again.maps_at;
  (void)assimilation::filter_fields(
      data_, {request_.base, maps_at.diffusion_ratio, maps_at.hypothesis, {}}, request_.filter,
      again.maps);
  assimilation::set_noise_model(again.fields_at.noise, request_.base, request_.filter, data_);
  assimilation::FilterModel model = Search::model(state);
  model.diffusion_ratio = again.fields_at.diffusion_ratio;
  model.hypothesis = again.fields_at.hypothesis;
  again.fields = assimilation::filter_fields(data_, model, request_.filter, again.maps);
  return forecasts_ = std::move(again);
}

std::vector<Refit> Search::refit_all(SearchState& state,
                                     const std::vector<assimilation::FilterModel>& trials,
                                     std::size_t first) {
  std::vector<std::size_t> open;
  std::vector<assimilation::FilterModel> open_trials;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    const auto known = state.refits.find(first + k);
    if (known != state.refits.end() &&
        known->second.hypothesis.name() == trials[k].hypothesis.name()) {
      tell(news_of(known->second, state.so_far.found));
      continue;
    }
    open.push_back(first + k);
    open_trials.push_back(trials[k]);
  }
  if (!open.empty()) {
    const std::vector<assimilation::ErrorMaps>& maps = forecasts(state).maps;
    refit_each(data(state), open_trials, request_.filter, maps,
               [&](std::size_t which, const Refit& fit) {
                 tell(news_of(fit, state.so_far.found));
                 state.refits[open[which]] = fit;
                 save(state);
               });
  }
  std::vector<Refit> refits;
  for (std::size_t k = 0; k < trials.size(); ++k) refits.push_back(state.refits.at(first + k));
  return refits;
}

void set_found(const Refit& fit, SearchState& state) {
  if (!fit.failure.empty()) throw std::runtime_error(fit.failure);
  state.so_far.found = fit;
}

bool is_among(const std::vector<std::string>& hypotheses, const Refit& fit) {
  return std::find(hypotheses.begin(), hypotheses.end(), fit.hypothesis.name()) != hypotheses.end();
}

bool was_dropped(const Explanation& result, const std::string& effect) {
  return std::any_of(result.changes.begin(), result.changes.end(), [&](const ModelChange& change) {
    return change.reason == ModelChange::is_none && change.from == effect;
  });
}

}  // namespace traceraft::selection
