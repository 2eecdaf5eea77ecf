#include "verification/explain/explanation.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>

namespace traceraft {
namespace {

// 2 ln of a likelihood ratio of 20: less does not tell two hypotheses apart.
constexpr double kTelling = 6;
// Candidates that gain less than this share of what the best one does, to first order, are not
// refitted, but for the second best.
constexpr double kWorthRefitting = 0.25;
// An effect has to change c by that many times what extrapolation to finer meshes does.
constexpr double kResolved = 3;

FilterProblem problem_of(const FieldSeries& series, const ExplainRequest& request) {
  const std::size_t held_out = request.hold_out && series.snapshots.size() >= 4 ? 1 : 0;
  return make_filter_problem(series, *request.surface, request.base.epsilon, request.cells,
                             request.threads, held_out, request.filter);
}

std::vector<Candidate> candidates_of(const ExplainRequest& request) {
  std::vector<Candidate> result;
  for (const Candidate& candidate : candidates())
    if (std::find(request.without.begin(), request.without.end(), candidate.effect) ==
        request.without.end())
      result.push_back(candidate);
  return result;
}

Gaps in_units_of_c(const Gaps& gaps, double noise) {
  return {noise * gaps.train, noise * gaps.heldout};
}

class Search {
 public:
  Search(const FieldSeries& series, const ExplainRequest& request)
      : series_(series),
        request_(request),
        data_(problem_of(series, request)),
        model_{request.base, 1, {}, candidates_of(request)} {}

  Explanation run() {
    tell("pace of the base model");
    fit_pace();
    for (int k = 0; k < request_.most_effects && look_for_one(); ++k) {
    }
    finish();
    return std::move(result_);
  }

 private:
  void tell(const std::string& step) const {
    if (request_.progress) request_.progress(step);
  }

  // With nothing missing, from a filter of a few directions.
  void fit_pace() {
    FilterSettings rough = request_.filter;
    rough.rank = 80;
    rough.replicates = 0;
    rough.tangent_steps = 2;
    FilterModel model{request_.base, 1, {}, {}};
    ErrorMaps maps;
    for (int k = 0; k < 5; ++k) {
      const FilterResult pass = filter_fields(data_, model, rough, maps);
      const double step = std::clamp(screen(pass, {}, 0).pace_change, -0.7, 0.7);
      model.pace *= std::exp(step);
      if (std::fabs(step) < 0.02) break;
    }
    model_.pace = model.pace;
  }

  // Before anything is known: the noise that the innovations have is that of the measurements.
  FilterResult first_pass() {
    const FilterResult pass = filter_fields(data_, model_, request_.filter, maps_);
    double squares = 0, values = 0;
    for (std::size_t k = 0; k + 1 < data_.train; ++k) {
      squares += pass.innovations[k].weighted_squares;
      values += static_cast<double>(pass.innovations[k].values.size());
    }
    data_.noise *= std::sqrt(squares / values);
    FilterResult again = filter_fields(data_, model_, request_.filter, maps_);
    result_.disagreements = disagreements(series_, again, request_.base.well);
    result_.disagreements.resize(significant(result_.disagreements, request_.false_alarms));
    set_found(refit_all({model_}).front());
    result_.base = result_.found;
    return again;
  }

  // With what was found last: errors of states and of the mesh are those of the model that has it.
  FilterResult next_pass() {
    maps_ = {};
    (void)filter_fields(data_, model_, request_.filter, maps_);
    set_found(refit_all({model_}).front());
    return filter_fields(data_, model_, request_.filter, maps_);
  }

  void set_found(const Refit& fit) {
    if (!fit.failure.empty()) throw std::runtime_error(fit.failure);
    result_.found = fit;
    model_.hypothesis = fit.hypothesis;
    model_.pace = fit.pace;
  }

  bool look_for_one() {
    const bool first = result_.rounds.empty();
    tell(first ? "what the base model lacks"
               : "what is lacking beside " + model_.hypothesis.name());
    const FilterResult pass = first ? first_pass() : next_pass();
    Round round{
        model_, screen(pass, model_.screened, model_.hypothesis.coefficients()), result_.found, {}};
    if (round.screening.p <= request_.false_alarms) refit_shortlist(round);
    result_.rounds.push_back(std::move(round));
    return judge(result_.rounds.back());
  }

  void refit_shortlist(Round& round) const {
    tell("refits");
    std::vector<FilterModel> trials;
    const double most = round.screening.scores.front().score;
    for (const CandidateScore& score : round.screening.scores) {
      const bool worth = score.score >= std::max(kTelling, kWorthRefitting * most);
      if (trials.size() == request_.shortlist || (trials.size() >= 2 && !worth)) break;
      trials.push_back(model_);
      trials.back().hypothesis.parts.push_back({candidate(score.effect), score.coefficients});
    }
    for (Refit& fit : refit_all(trials))
      if (fit.failure.empty()) round.refits.push_back(std::move(fit));
    std::sort(round.refits.begin(), round.refits.end(),
              [this](const Refit& a, const Refit& b) { return criterion(a) < criterion(b); });
  }

  std::vector<Refit> refit_all(const std::vector<FilterModel>& trials) const {
    std::vector<Refit> refits(trials.size());
    std::atomic<std::size_t> next{0};
    data_.team->run([&](int) {
      for (std::size_t k = next++; k < trials.size(); k = next++)
        refits[k] = refit(data_, trials[k], request_.filter, maps_);
    });
    return refits;
  }

  // Schwarz' (1978): an effect with a second coefficient has to earn it, above all if one without
  // is a special case of it.
  double criterion(const Refit& fit) const {
    double values = 0;
    for (std::size_t k = 1; k < data_.train; ++k)
      values += static_cast<double>(data_.snapshots[k].values.size());
    return fit.deviance + std::log(values) * static_cast<double>(fit.hypothesis.coefficients());
  }

  Candidate candidate(const std::string& effect) const {
    return *std::find_if(model_.screened.begin(), model_.screened.end(),
                         [&](const Candidate& c) { return c.effect == effect; });
  }

  // Takes the best effect into the model if it is one. Is there a reason to look for more?
  bool judge(const Round& round) {
    const bool first = result_.rounds.size() == 1;
    if (round.refits.empty()) {
      if (round.screening.gap_p <= request_.false_alarms) result_.finding = Finding::unnamed;
      return false;
    }
    const Refit& best = round.refits.front();
    const std::string effect = best.hypothesis.parts.back().candidate.effect;
    const auto score = std::find_if(round.screening.scores.begin(), round.screening.scores.end(),
                                    [&](const CandidateScore& s) { return s.effect == effect; });
    if (criterion(round.without) < criterion(best) ||
        score->response < kResolved * round.screening.mesh_error) {
      if (first) result_.finding = Finding::below_resolution;
      return false;
    }
    set_found(best);
    result_.equivalent = {effect};
    for (std::size_t k = 1; k < round.refits.size(); ++k)
      if (criterion(round.refits[k]) < criterion(best) + kTelling)
        result_.equivalent.push_back(round.refits[k].hypothesis.parts.back().candidate.effect);
    result_.finding = result_.equivalent.size() > 1 ? Finding::ambiguous : Finding::named;
    model_.screened.erase(std::remove_if(model_.screened.begin(), model_.screened.end(),
                                         [&](const Candidate& c) { return c.effect == effect; }),
                          model_.screened.end());
    return true;
  }

  void finish() {
    result_.noise = data_.noise;
    result_.replicates = request_.filter.replicates;
    const auto& refits = result_.rounds.front().refits;
    result_.base_gap = in_units_of_c(result_.base.gap, data_.noise);
    result_.found_gap = in_units_of_c(result_.found.gap, data_.noise);
    result_.placebo_gap =
        in_units_of_c((refits.size() > 1 ? refits[1] : result_.base).gap, data_.noise);
    result_.floor = in_units_of_c(result_.found.expected, data_.noise);
  }

  const FieldSeries& series_;
  const ExplainRequest& request_;
  FilterProblem data_;
  FilterModel model_;
  ErrorMaps maps_;
  Explanation result_;
};

}  // namespace

std::string word_for(Finding finding) {
  switch (finding) {
    case Finding::none:
      return "none";
    case Finding::named:
      return "named";
    case Finding::ambiguous:
      return "ambiguous";
    case Finding::below_resolution:
      return "below-solver-resolution";
    case Finding::unnamed:
      return "unnamed";
  }
  return "";
}

Gaps gaps_of_model(const FieldSeries& series, const ExplainRequest& request, double pace,
                   const std::vector<EffectTerm>& effects) {
  ExplainRequest alone = request;
  alone.filter.replicates = 0;
  const FilterProblem data = problem_of(series, alone);
  ErrorMaps maps;
  const Gaps gaps = gaps_of_pass(
      data,
      filter_fields(data, {with_effects(request.base, effects), pace, {}, {}}, alone.filter, maps));
  return in_units_of_c(gaps, data.noise);
}

Explanation explain_fields(const FieldSeries& series, const ExplainRequest& request) {
  return Search(series, request).run();
}

}  // namespace traceraft
