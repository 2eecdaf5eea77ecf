// The search for effects: what it has at hand, and what it has found so far.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "verification/explain/search/explanation.hpp"

namespace traceraft {

struct Search {
  const ExplainRequest& request;  // has to outlive the search
  FilterProblems data;
  std::vector<Candidate> candidates;
  FilterModel model;            // with what was found; the other candidates are screened
  std::vector<ErrorMaps> maps;  // of its forecasts
  Explanation result;
  bool told_apart = false;  // has what is held out been asked about the class?

  Search(const std::vector<FieldSeries>& series, const ExplainRequest& explain_request);

  double h_over_epsilon() const { return data.front().space->h() / request.base.epsilon; }
  double values() const { return count_values(data); }
  // Of the last round's.
  double mesh_error() const { return result.rounds.back().screening.mesh_error; }

  void tell(const std::string& step) const;

  // The fit is the model from now on. Throws std::runtime_error for one that failed.
  void set_found(const Refit& fit);

  // What the forecasts of the base model leave, and its refit.
  FilterResult first_pass();
  // What those of the model leave, once it is refitted: the noise, and the errors of states and of
  // the mesh, are its own. Throws std::runtime_error if a forecast fails.
  FilterResult next_pass();

  // In their order, with news of each; those that an interrupted search has had are not done again.
  std::vector<Refit> refit_all(const std::vector<FilterModel>& trials);

  SearchState state(bool more) const;
  void save(const SearchState& state) const;
  void go_on_from(const SearchState& state);
  // `ahead`: refits of it that an interrupted search has had.
  void begin_round(bool more, std::map<std::size_t, Refit> ahead);

 private:
  // The noise is that of the model, which begins with this pass; where neighbours share another
  // part of it, maps and passes are repeated with that.
  void settle_noise(FilterResult pass);
  void tell_gain(const Refit& fit) const;
  // Weakens effects that the model has until it can be advanced.
  FilterResult pass_with_own_effects();

  SearchState before_;        // the round, with the refits that it has had
  std::size_t numbered_ = 0;  // refits of the round
};

// By the names of its effects.
bool is_among(const std::vector<std::string>& hypotheses, const Refit& fit);

}  // namespace traceraft
