#include "verification/explain/explanation.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "verification/explain/neighbours.hpp"

namespace traceraft {
namespace {

// Candidates that gain less than this share of what the best one does, to first order, are not
// refitted, but for the second best.
constexpr double kWorthRefitting = 0.25;
// From one snapshot to the next, in units of the standard deviation of c: what effects are hardly
// looked for below.
constexpr double kUsualChange = 0.06;
// Effects that are replaced or dropped at once.
constexpr int kMostMoves = 3;
// Of means over the neighbourhood, in widths of phase boundaries.
constexpr double kMapWidth = 2;
// The mesh and the integrator of the second run of what was found.
constexpr double kOtherCells = 1.15;
constexpr char kOtherIntegrator[] = "rosenbrock";

FilterProblems problems_of(const std::vector<FieldSeries>& series, const ExplainRequest& request) {
  return make_filter_problems(series, *request.surface, request.base.epsilon, request.cells,
                              request.threads, request.hold_out, request.filter);
}

// Of the measurements, over all vesicles.
double noise_of(const FilterProblems& problems) {
  double squares = 0;
  for (const FilterProblem& data : problems) squares += data.noise * data.noise;
  return std::sqrt(squares / static_cast<double>(problems.size()));
}

// Of all that was measured, the noise among it.
double deviation_of(const std::vector<FieldSeries>& series) {
  double sum = 0, squares = 0, count = 0;
  for (const FieldSeries& vesicle : series)
    for (const FieldSnapshot& snapshot : vesicle.snapshots) {
      sum += snapshot.values.sum();
      squares += snapshot.values.squaredNorm();
      count += static_cast<double>(snapshot.values.size());
    }
  return std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
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
  Search(const std::vector<FieldSeries>& series, const ExplainRequest& request)
      : series_(series),
        request_(request),
        data_(problems_of(series, request)),
        model_{request.base, 1, {}, candidates_of(request)} {}

  Explanation run(const std::optional<SearchState>& saved) {
    bool more = true;
    if (saved) {
      more = saved->more;
      go_on_from(*saved);
    } else {
      tell("pace of the base model");
      fit_pace();
    }
    while (more) {
      more = look_for_one();
      save(more);
    }
    finish();
    return std::move(result_);
  }

 private:
  void tell(const std::string& step) const {
    if (request_.progress) request_.progress(step);
  }

  void save(bool more) const {
    if (!request_.save) return;
    SearchState state{result_, {}, more};
    for (const FilterProblem& data : data_) state.noise.push_back(data.noise);
    request_.save(state);
  }

  void go_on_from(const SearchState& state) {
    tell("what was found before");
    result_ = state.so_far;
    for (FilterProblem& data : data_) data.noise = state.noise[data.vesicle];
    model_.hypothesis = result_.found.hypothesis;
    model_.pace = result_.found.pace;
    screen_the_rest();
  }

  void screen_the_rest() {
    model_.screened = candidates_of(request_);
    for (const auto& part : model_.hypothesis.parts)
      model_.screened.erase(
          std::find_if(model_.screened.begin(), model_.screened.end(),
                       [&](const Candidate& c) { return c.effect == part.candidate.effect; }));
  }

  // Beside an effect that was taken, those before it may stand for something else.
  void improve() {
    for (int k = 0; k < kMostMoves && model_.hypothesis.parts.size() > 1; ++k) {
      tell("in place of " + model_.hypothesis.name());
      std::vector<FilterModel> trials;
      for (Hypothesis& near :
           neighbours(result_.found, result_.rounds, values(), candidates_of(request_))) {
        trials.push_back(model_);
        trials.back().hypothesis = std::move(near);
      }
      const double here = criterion(result_.found, values());
      const Refit* best = nullptr;
      const std::vector<Refit> fits = refit_all(trials);
      for (const Refit& fit : fits)
        if (fit.failure.empty() && criterion(fit, values()) < here &&
            (best == nullptr || criterion(fit, values()) < criterion(*best, values())))
          best = &fit;
      if (best == nullptr) break;
      set_found(*best);
      result_.finding = Finding::named;
      result_.equivalent = {model_.hypothesis.parts.back().candidate.effect};
    }
    screen_the_rest();
  }

  // With nothing missing, from a filter of a few directions.
  void fit_pace() {
    FilterSettings rough = request_.filter;
    rough.rank = 80;
    rough.replicates = 0;
    rough.tangent_steps = 2;
    FilterModel model{request_.base, 1, {}, {}};
    std::vector<ErrorMaps> maps;
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
    std::vector<double> squares(data_.size(), 0.0), values(data_.size(), 0.0);
    for (const Innovation& in : pass.innovations) {
      if (in.held_out) continue;
      squares[in.vesicle] += in.weighted_squares;
      values[in.vesicle] += static_cast<double>(in.values.size());
    }
    for (FilterProblem& data : data_)
      data.noise *= std::sqrt(squares[data.vesicle] / values[data.vesicle]);
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

  // Returns whether there may be more.
  bool look_for_one() {
    const bool first = result_.rounds.empty();
    tell(first ? "what the base model lacks"
               : "what is lacking beside " + model_.hypothesis.name());
    const FilterResult pass = first ? first_pass() : next_pass();
    const CutSurface& surface = data_.front().space->surface;
    result_.found_maps =
        disagreement_maps(series_, pass, surface.position, kMapWidth * request_.base.epsilon);
    if (first) result_.base_maps = result_.found_maps;
    Round round{
        model_, screen(pass, model_.screened, model_.hypothesis.coefficients()), result_.found, {}};
    const auto most = static_cast<std::size_t>(request_.most_effects);
    const bool more =
        model_.hypothesis.parts.size() < most && result_.rounds.size() < most + kMostMoves;
    if (more && round.screening.p <= request_.false_alarms) refit_shortlist(round);
    result_.rounds.push_back(std::move(round));
    return take(result_.rounds.back());
  }

  void refit_shortlist(Round& round) const {
    tell("refits");
    std::vector<FilterModel> trials;
    const double most = round.screening.scores.front().score;
    for (const CandidateScore& score : round.screening.scores) {
      const bool worth = score.score >= std::max(kTelling, kWorthRefitting * most);
      if (trials.size() == request_.shortlist || (trials.size() >= 2 && !worth)) break;
      trials.push_back(model_);
      trials.back().hypothesis.parts.push_back({*find_candidate(score.effect), score.coefficients});
    }
    for (Refit& fit : refit_all(trials))
      if (fit.failure.empty()) round.refits.push_back(std::move(fit));
    std::sort(round.refits.begin(), round.refits.end(),
              [n = values()](const Refit& a, const Refit& b) {
                return criterion(a, n) < criterion(b, n);
              });
  }

  std::vector<Refit> refit_all(const std::vector<FilterModel>& trials) const {
    if (trials.size() == 1) return {refit(data_, trials[0], request_.filter, maps_)};
    std::vector<Refit> refits(trials.size());
    std::atomic<std::size_t> next{0};
    data_.front().team->run([&](int) {
      for (std::size_t k = next++; k < trials.size(); k = next++)
        refits[k] = refit(data_, trials[k], request_.filter, maps_);
    });
    return refits;
  }

  // That were measured and count, the first snapshots aside.
  double values() const {
    double count = 0;
    for (const FilterProblem& data : data_)
      for (std::size_t k = 1; k < data.train; ++k)
        count += static_cast<double>(data.snapshots[k].values.size());
    return count;
  }

  bool take(const Round& round) {
    const double usual_change = kUsualChange * deviation_of(series_) / noise_of(data_);
    const Judgement judgement = judge(round, values(), request_.false_alarms, usual_change);
    if (!judgement.taken) {
      // What could not be told apart before cannot be now.
      if (judgement.finding != Finding::named) result_.finding = judgement.finding;
      return false;
    }
    result_.finding = judgement.finding;
    result_.equivalent = judgement.equivalent;
    set_found(round.refits.front());
    improve();
    return true;
  }

  void finish() {
    const double noise = noise_of(data_);
    result_.noise = noise;
    const CutSurface& surface = data_.front().space->surface;
    result_.map_mesh = {surface.position, surface.triangles};
    result_.replicates = request_.filter.replicates;
    const auto& refits = result_.rounds.front().refits;
    result_.base_gap = in_units_of_c(result_.base.gap, noise);
    result_.found_gap = in_units_of_c(result_.found.gap, noise);
    result_.placebo_gap = in_units_of_c((refits.size() > 1 ? refits[1] : result_.base).gap, noise);
    result_.floor = in_units_of_c(result_.found.expected, noise);
    const Round& last = result_.rounds.back();
    result_.bounds = bounds_of(last.screening, last.known.screened);
    if (request_.rerun && !result_.found.hypothesis.parts.empty()) run_again();
  }

  void run_again() {
    tell("once more, on another mesh and by another integrator");
    ExplainRequest other = request_;
    other.cells = static_cast<int>(std::lround(kOtherCells * request_.cells));
    other.filter.integrator = kOtherIntegrator;
    other.threads = 1;
    const std::array<FilterModel, 2> models{
        {{request_.base, result_.base.pace, {}, {}},
         {request_.base, result_.found.pace, result_.found.hypothesis, {}}}};
    std::array<ModelGaps, 2> gaps;
    data_.front().team->run([&](int lane) {
      for (int k = lane; k < 2; k += request_.threads)
        gaps[k] = gaps_of_model(series_, other, models[k].pace, models[k].hypothesis.terms());
    });
    result_.rerun = {other.cells, kOtherIntegrator, gaps[0].gap, gaps[1].gap,
                     in_units_of_c(gaps[1].expected, result_.noise)};
  }

  const std::vector<FieldSeries>& series_;
  const ExplainRequest& request_;
  FilterProblems data_;
  FilterModel model_;
  std::vector<ErrorMaps> maps_;
  Explanation result_;
};

}  // namespace

ModelGaps gaps_of_model(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                        double pace, const std::vector<EffectTerm>& effects) {
  ExplainRequest alone = request;
  alone.filter.replicates = 0;
  const FilterProblems data = problems_of(series, alone);
  std::vector<ErrorMaps> maps;
  const FilterResult pass =
      filter_fields(data, {with_effects(request.base, effects), pace, {}, {}}, alone.filter, maps);
  return {in_units_of_c(gaps_of_pass(pass), noise_of(data)), expected_gaps(pass)};
}

Explanation explain_fields(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                           const std::optional<SearchState>& saved) {
  return Search(series, request).run(saved);
}

}  // namespace traceraft
