// The tools of a search beside its state: the data, the candidates, and forecasts.
#pragma once

#include <string>
#include <vector>

#include "verification/selection/search/search_state.hpp"

namespace traceraft::selection {

assimilation::FilterProblems problems_of(const std::vector<assimilation::FieldSeries>& series,
                                         const ExplainRequest& request);

// Told before they are made.
inline constexpr char kForecastNews[] = "  forecasts, errors of states and of the mesh";

// Forecasts of the last calibration.
struct Forecasts {
  ForecastPoint maps_at, fields_at;
  std::vector<assimilation::ErrorMaps> maps;
  assimilation::FilterResult fields;
};

// Its methods return the same for the same state, whatever was asked before.
class Search {
 public:
  // The request has to outlive the search.
  Search(const std::vector<assimilation::FieldSeries>& series, const ExplainRequest& request);

  const ExplainRequest& request() const { return request_; }
  const std::vector<assimilation::FieldSeries>& series() const { return series_; }
  const std::vector<assimilation::Candidate>& candidates() const { return candidates_; }
  double values() const { return assimilation::count_values(data_); }
  double h_over_epsilon() const { return data_.front().space->h() / request_.base.epsilon; }

  void tell(const std::string& news) const;
  void save(const SearchState& state) const;

  // The data with the noise of a state; at its start, with that of single fields. Throws
  // std::runtime_error if the first fields cannot be estimated with it.
  assimilation::FilterProblems& data(const SearchState& state);
  assimilation::FilterProblems& data_at_start() { return data_; }

  // The found model; the candidates that it has not are screened.
  assimilation::FilterModel model(const SearchState& state) const;

  // A calibration hands over its forecasts. A search that was interrupted finds them again.
  void keep(Forecasts forecasts) { forecasts_ = std::move(forecasts); }
  const Forecasts& forecasts(const SearchState& state);

  // The trials fitted, in their order, with news of each. Those that state.refits has are not
  // fitted again; the others are added to it and saved. `first`: the number of the first one
  // among the refits of the step.
  std::vector<Refit> refit_all(SearchState& state,
                               const std::vector<assimilation::FilterModel>& trials,
                               std::size_t first = 0);

 private:
  const std::vector<assimilation::FieldSeries>& series_;
  const ExplainRequest& request_;
  assimilation::FilterProblems data_;
  std::vector<assimilation::Candidate> candidates_;
  Forecasts forecasts_;
};

// The error of the mesh, as the last round's screening has it (Screening::mesh_error).
inline double mesh_error(const SearchState& state) {
  return state.so_far.rounds.back().screening.mesh_error;
}

// The fit is the model from now on. Throws std::runtime_error for one that failed.
void set_found(const Refit& fit, SearchState& state);

// By the names of its effects.
bool is_among(const std::vector<std::string>& hypotheses, const Refit& fit);

bool was_dropped(const Explanation& result, const std::string& effect);

}  // namespace traceraft::selection
