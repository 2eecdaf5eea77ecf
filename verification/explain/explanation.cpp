#include "verification/explain/explanation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/core/text.hpp"
#include "verification/explain/class_evidence.hpp"
#include "verification/explain/first_pace.hpp"
#include "verification/explain/neighbours.hpp"
#include "verification/explain/noise_levels.hpp"
#include "verification/explain/shortlist.hpp"

namespace traceraft {
namespace {

// From one snapshot to the next, in units of the standard deviation of c: what effects are hardly
// looked for below.
constexpr double kUsualChange = 0.06;
// Effects that are replaced or dropped at once.
constexpr int kMostMoves = 3;
// Of means over the neighbourhood, in widths of phase boundaries.
constexpr double kMapWidth = 2;
// Beyond that many standard deviations a snapshot is said to be turned or scaled.
constexpr double kChanged = 3;

class Search {
 public:
  Search(const std::vector<FieldSeries>& series, const ExplainRequest& request)
      : request_(request),
        data_(problems_of(series, request)),
        candidates_(candidates_for(request.base, *request.surface,
                                   data_.front().space->surface.position, request.without)),
        model_{request.base, 1, {}, candidates_} {}

  Explanation run(const std::optional<SearchState>& saved) {
    bool more = true;
    tell(formatted("%d cells, h/epsilon = %.2f%s", request_.cells, h_over_epsilon(),
                   h_over_epsilon() > kCoarse ? ": COARSE, more --cells would say more" : ""));
    if (saved) {
      more = saved->more;
      tell("what was found before");
      go_on_from(*saved);
    } else {
      tell("pace of the base model");
      model_.pace = first_pace(data_, request_.base, request_.filter);
      const bool far = std::fabs(std::log(model_.pace)) > std::log(kFarPace);
      tell(formatted("  D is about %.2g times the model's%s", model_.pace,
                     far ? ": are time_unit and the model's --diffusion right?" : ""));
    }
    while (more) {
      more = look_for_one() || tell_apart();
      save(more);
    }
    finish();
    return std::move(result_);
  }

 private:
  double h_over_epsilon() const { return data_.front().space->h() / request_.base.epsilon; }

  void tell(const std::string& step) const {
    if (request_.progress) request_.progress(step);
  }

  std::vector<Refit> refit_all(const std::vector<FilterModel>& trials) const {
    return refit_each(data_, trials, request_.filter, maps_, [&](const Refit& fit) {
      // With one effect more there is nothing to lose.
      const bool more = fit.hypothesis.parts.size() > result_.found.hypothesis.parts.size();
      const double difference = result_.found.deviance - fit.deviance;
      const double gained = more ? std::max(0.0, difference) : difference;
      tell("  " + fit.hypothesis.name() +
           (fit.failure.empty() ? " gains " + std::to_string(std::lround(gained)) : " fails"));
    });
  }

  SearchState state(bool more) const {
    SearchState now{result_, {}, more, told_apart_};
    for (const FilterProblem& data : data_) now.noise.push_back(data.noise);
    return now;
  }

  void save(bool more) const {
    if (request_.save) request_.save(state(more));
  }

  void go_on_from(const SearchState& state) {
    result_ = state.so_far;
    told_apart_ = state.told_apart;
    for (FilterProblem& data : data_) data.noise = state.noise[data.vesicle];
    model_.hypothesis = result_.found.hypothesis;
    model_.pace = result_.found.pace;
    screen_the_rest();
  }

  void screen_the_rest() {
    model_.screened = candidates_;
    for (const auto& part : model_.hypothesis.parts)
      model_.screened.erase(
          std::find_if(model_.screened.begin(), model_.screened.end(),
                       [&](const Candidate& c) { return c.effect == part.candidate.effect; }));
  }

  // Beside an effect that was taken, those before it may stand for something else.
  void improve() {
    for (int move = 0; model_.hypothesis.parts.size() > 1 || move > 0; ++move) {
      tell("in place of " + model_.hypothesis.name());
      std::vector<FilterModel> trials;
      for (Hypothesis& near : neighbours(result_.found, result_.rounds, values(), candidates_)) {
        trials.push_back(model_);
        trials.back().hypothesis = std::move(near);
      }
      const std::vector<Refit> fits = refit_all(trials);
      const Refit* best = move < kMostMoves ? better_one(fits) : nullptr;
      if (best == nullptr) {
        add_rivals(fits);
        break;
      }
      set_found(*best);
      result_.rivals.clear();
    }
    result_.finding = result_.rivals.empty() ? Finding::named : Finding::ambiguous;
    screen_the_rest();
  }

  const Refit* better_one(const std::vector<Refit>& fits) const {
    const Refit* best = &result_.found;
    for (const Refit& fit : fits)
      if (fit.failure.empty() && criterion(fit, values()) < criterion(*best, values()) &&
          all_resolved(fit))
        best = &fit;
    return best == &result_.found ? nullptr : best;
  }

  bool all_resolved(const Refit& fit) const {
    for (std::size_t k = 0; k < fit.hypothesis.parts.size(); ++k)
      if (!resolved(fit, k, values(), mesh_error())) return false;
    return true;
  }

  double mesh_error() const { return result_.rounds.back().screening.mesh_error; }

  void add_rivals(const std::vector<Refit>& fits) {
    const double limit = telling(values(), mesh_error());
    for (const Refit& fit : fits)
      if (fit.failure.empty() && explains_as_well(fit, result_.found, values(), limit) &&
          fit.hypothesis.parts.size() == model_.hypothesis.parts.size() &&
          !is_among(class_of(result_), fit))
        result_.rivals.push_back(fit);
  }

  static bool is_among(const std::vector<std::string>& names, const Refit& fit) {
    return std::find(names.begin(), names.end(), fit.hypothesis.name()) != names.end();
  }

  FilterResult first_pass() {
    fit_noise(data_, filter_fields(data_, model_, request_.filter, maps_));
    FilterResult pass = filter_fields(data_, model_, request_.filter, maps_);
    result_.disagreements = disagreements(data_, pass, request_.base.well);
    result_.disagreements.resize(significant(result_.disagreements, request_.false_alarms));
    set_found(refit(data_, model_, request_.filter, maps_));
    bootstrap(pass, model_, result_.found);
    result_.base = result_.found;
    return pass;
  }

  // With what was found last: errors of states and of the mesh are those of the model that has it.
  FilterResult next_pass() {
    maps_ = {};
    fit_noise(data_, filter_fields(data_, model_, request_.filter, maps_));
    set_found(refit(data_, model_, request_.filter, maps_));
    FilterResult pass = filter_fields(data_, model_, request_.filter, maps_);
    bootstrap(pass, model_, result_.found);
    return pass;
  }

  void note_changes(const FilterResult& pass) {
    const FilterSettings& known = request_.filter;
    result_.changes.clear();
    for (const Innovation& in : pass.innovations) {
      if (in.frame.cwiseAbs().maxCoeff() < kChanged) continue;
      const double turn = known.turn * in.frame.head(3).norm();
      const double offset = known.offset * (request_.base.well.b - request_.base.well.a);
      result_.changes.push_back(
          {in.vesicle, in.snapshot, turn, known.gain * in.frame[3], offset * in.frame[4]});
    }
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
    FilterResult pass;
    try {
      pass = first ? first_pass() : next_pass();
    } catch (const std::runtime_error& error) {
      if (first) throw;
      result_.stopped = error.what();
      return false;
    }
    note_changes(pass);
    result_.found_maps = disagreement_maps(data_, pass, data_.front().space->surface.position,
                                           kMapWidth * request_.base.epsilon);
    if (first) result_.base_maps = result_.found_maps;
    Round round{model_, screen(pass, model_.screened, model_.hypothesis), result_.found, {}, {}};
    const auto most = static_cast<std::size_t>(request_.most_effects);
    const bool more =
        model_.hypothesis.parts.size() < most && result_.rounds.size() < most + kMostMoves;
    if (more && round.screening.p <= request_.false_alarms) refit_shortlist(round);
    result_.rounds.push_back(std::move(round));
    return take(result_.rounds.back());
  }

  // First orders of an effect that another D makes up for may lie beyond a ridge, from where the
  // way does not lead back: where such refits end worse than without the effect, they begin once
  // more with nothing of it.
  std::vector<Refit> refit_again(const std::vector<FilterModel>& trials,
                                 std::vector<Refit> fits) const {
    std::vector<FilterModel> again;
    std::vector<std::size_t> which;
    for (std::size_t k = 0; k < fits.size(); ++k) {
      if (fits[k].failure.empty() && fits[k].deviance <= result_.found.deviance) continue;
      again.push_back(trials[k]);
      std::vector<double>& coefficients = again.back().hypothesis.parts.back().coefficients;
      coefficients.assign(coefficients.size(), 0);
      which.push_back(k);
    }
    if (again.empty()) return fits;
    tell("  from where they do nothing");
    std::vector<Refit> better = refit_all(again);
    for (std::size_t k = 0; k < which.size(); ++k)
      if (better[k].failure.empty()) fits[which[k]] = std::move(better[k]);
    return fits;
  }

  void refit_shortlist(Round& round) const {
    tell("refits: 2 ln of the likelihood ratio that an effect gains");
    std::vector<FilterModel> trials;
    const double limit = telling(values(), round.screening.mesh_error);
    for (Hypothesis::Part& part : shortlist(round.screening, request_.shortlist, limit)) {
      trials.push_back(model_);
      trials.back().hypothesis.parts.push_back(std::move(part));
    }
    for (const Refit& fit : refit_again(trials, refit_all(trials)))
      if (fit.failure.empty())
        round.refits.push_back(no_worse(fit, round.without));
      else
        round.failures.push_back({last_effect(fit.hypothesis), fit.failure});
    std::sort(round.refits.begin(), round.refits.end(),
              [n = values()](const Refit& a, const Refit& b) {
                return criterion(a, n) < criterion(b, n);
              });
  }

  double values() const { return count_values(data_); }

  bool take(const Round& round) {
    const double usual_change = kUsualChange * contrast_of(data_) / noise_of(data_);
    const Judgement judgement = judge(round, values(), request_.false_alarms, usual_change);
    if (!judgement.taken) {
      if (judgement.finding == Finding::unnamed && leave_to_rivals()) return true;
      result_.without_gap =
          judgement.without_gap == Finding::named ? result_.finding : judgement.without_gap;
      // What could not be told apart before cannot be now.
      if (judgement.finding != Finding::named) result_.finding = judgement.finding;
      return false;
    }
    result_.finding = judgement.finding;
    result_.rivals.clear();
    for (std::size_t k = 1; k < round.refits.size(); ++k)
      if (is_among(judgement.equivalent, round.refits[k]))
        result_.rivals.push_back(round.refits[k]);
    set_found(round.refits.front());
    improve();
    return true;
  }

  // Of hypotheses that explain what counts as well as each other some may foretell what is held out
  // worse: the class is left to those that leave no gap, in their order. False if there is none.
  bool leave_to_rivals() {
    const SearchState before = state(true);
    std::vector<Refit> without_gap;
    for (const Refit& rival : before.so_far.rivals) {
      tell("instead " + rival.hypothesis.name());
      go_on_from(before);
      set_found(rival);
      screen_the_rest();
      try {
        const Screening left = screen(next_pass(), model_.screened, model_.hypothesis);
        if (!has_gap(left, request_.false_alarms)) without_gap.push_back(result_.found);
      } catch (const std::runtime_error& error) {
        tell("  fails: " + std::string(error.what()));
      }
    }
    go_on_from(before);
    if (without_gap.empty()) return false;
    set_found(without_gap.front());
    screen_the_rest();
    result_.rivals.assign(without_gap.begin() + 1, without_gap.end());
    result_.finding = result_.rivals.empty() ? Finding::named : Finding::ambiguous;
    return true;
  }

  bool class_is_open() const {
    const bool open =
        result_.finding == Finding::ambiguous ||
        (result_.finding == Finding::unnamed && result_.without_gap == Finding::ambiguous);
    return open && result_.stopped.empty() && !result_.rivals.empty() && holds_out(data_);
  }

  // What is held out counts, too, between the members of a class. Returns whether another one than
  // was found comes first then; the search goes on beside that.
  bool tell_apart() {
    if (told_apart_ || !class_is_open()) return false;
    told_apart_ = true;
    tell("what is held out says of the class");
    std::vector<Refit> members{result_.found};
    members.insert(members.end(), result_.rivals.begin(), result_.rivals.end());
    const FilterProblems all = holding_nothing_out(data_);
    const auto criteria = criteria_of(all, request_.base, members, request_.filter);
    if (!criteria.front()) return false;
    std::size_t best = 0;
    for (std::size_t k = 1; k < members.size(); ++k)
      if (criteria[k] && *criteria[k] < *criteria[best]) best = k;
    if (result_.finding == Finding::unnamed) best = 0;  // its gap is that of the found one
    const double limit = telling(count_values(all), mesh_error());
    result_.rivals.clear();
    for (std::size_t k = 0; k < members.size(); ++k) {
      const double worse = criteria[k] ? *criteria[k] - *criteria[best] : 0;
      tell("  " + members[k].hypothesis.name() + " gains " + std::to_string(std::lround(-worse)));
      if (worse >= limit)
        result_.told_apart.push_back({members[k].hypothesis.name(), worse});
      else if (k != best)
        result_.rivals.push_back(members[k]);
    }
    if (result_.rivals.empty())
      (result_.finding == Finding::unnamed ? result_.without_gap : result_.finding) =
          Finding::named;
    if (best == 0) return false;
    set_found(members[best]);
    screen_the_rest();
    return true;
  }

  void finish() {
    result_.noise = noise_of(data_);
    for (const FilterProblem& data : data_) result_.outliers += data.outliers;
    const CutSurface& surface = data_.front().space->surface;
    result_.map_mesh = {surface.position, surface.triangles};
    result_.replicates = request_.filter.replicates;
    result_.false_alarms = request_.false_alarms;
    result_.blur_stated = request_.blur_stated;
    result_.pace_doubt = request_.filter.pace_doubt;
    result_.h_over_epsilon = h_over_epsilon();
    const auto& refits = result_.rounds.front().refits;
    for (const FilterProblem& data : data_) result_.noises.push_back(data.noise);
    result_.base_gap = result_.base.gap;
    result_.found_gap = result_.found.gap;
    const auto placebo = std::find_if(refits.begin(), refits.end(), [&](const Refit& fit) {
      return !is_no_other(fit, refits.front()) &&
             !result_.found.hypothesis.has(last_effect(fit.hypothesis));
    });
    if (placebo != refits.end()) result_.placebo_gap = placebo->gap;
    result_.floor = result_.found.expected;
    screen_the_rest();
    // Beside what was found; where the search had to stop nothing was looked for beside it.
    if (result_.stopped.empty())
      result_.bounds = bounds_of(result_.rounds.back().screening, model_.screened);
  }

  const ExplainRequest& request_;
  FilterProblems data_;
  const std::vector<Candidate> candidates_;
  FilterModel model_;
  std::vector<ErrorMaps> maps_;
  Explanation result_;
  bool told_apart_ = false;
};

}  // namespace

bool is_named(const Explanation& found) {
  return found.finding == Finding::named || found.finding == Finding::ambiguous;
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
  return Search(series, request).run(saved);
}

}  // namespace traceraft
