// One round of the search: what the model leaves, what that is most like, and whether it is taken.
#include <algorithm>
#include <cmath>

#include "kernel/core/text.hpp"
#include "verification/selection/search/shortlist.hpp"
#include "verification/selection/search/steps.hpp"

namespace traceraft::selection {
namespace {

// From one snapshot to the next, in units of the standard deviation of c: what effects are hardly
// looked for below.
constexpr double kUsualChange = 0.06;
// Rounds beyond the most effects, as effects may be replaced or dropped.
constexpr std::size_t kMoreRounds = 3;
// Width of the neighbourhood that maps are means over, in widths of phase boundaries.
constexpr double kMapWidth = 2;
// D is far from the model's from this factor on.
constexpr double kFarFromModel = 3;
// Beyond that many standard deviations a snapshot is said to be rotated or scaled.
constexpr double kChanged = 3;

std::vector<FrameChange> frame_changes(const assimilation::FilterResult& fields,
                                       const ExplainRequest& request) {
  const assimilation::FilterSettings& known = request.filter;
  const double offset = known.offset * (request.base.well.b - request.base.well.a);
  std::vector<FrameChange> changes;
  for (const assimilation::Innovation& in : fields.innovations) {
    const auto changed = [&](Eigen::Index k) { return std::fabs(in.frame[k]) >= kChanged; };
    const bool rotated = changed(0) || changed(1) || changed(2);
    if (!rotated && !changed(3) && !changed(4)) continue;
    changes.push_back({in.vesicle, in.snapshot, rotated ? known.turn * in.frame.head(3).norm() : 0,
                       changed(3) ? known.gain * in.frame[3] : 0,
                       changed(4) ? offset * in.frame[4] : 0});
  }
  return changes;
}

// Says what is left. Is it worth while to look for more?
bool progresses(const Search& search, const Explanation& result) {
  if (result.rounds.empty()) return true;
  if (const auto closed = shares_closed(result.base, result.found).train)
    search.tell(formatted("  %.0f %% of the gap is left", 100 * (1 - *closed)));
  const std::optional<double> last = closed_by_last_round(result);
  if (!last || *last >= kLeastProgress) return true;
  search.tell(formatted("  the last round closed %.0f %% of the remaining gap; the search ends",
                        100 * std::max(0.0, *last)));
  return false;
}

// Refits of some trials from other starts, which take the place of those that are less probable.
struct OtherStarts {
  std::vector<assimilation::FilterModel> starts;
  std::vector<std::size_t> which;  // of the trials

  // A trial without any of its last effect.
  void add(std::size_t trial, assimilation::FilterModel start) {
    std::vector<double>& coefficients = start.hypothesis.parts.back().coefficients;
    coefficients.assign(coefficients.size(), 0);
    starts.push_back(std::move(start));
    which.push_back(trial);
  }
  void refit(Search& search, SearchState& state, std::size_t before,
             std::vector<Refit>& fits) const {
    std::vector<Refit> others = search.refit_all(state, starts, before);
    for (std::size_t k = 0; k < which.size(); ++k) {
      Refit& fit = fits[which[k]];
      const bool failed = !fit.failure.empty();
      if (others[k].failure.empty() && (failed || others[k].deviance < fit.deviance))
        fit = std::move(others[k]);
    }
  }
};

// First orders of an effect that another D makes up for may lie beyond a ridge, from where the way
// does not lead back: where such refits end worse than without the effect, they begin once more
// with nothing of it. Where what is missing has driven D far from that of the model, they also
// begin at that one.
void refit_from_nothing(Search& search, SearchState& state,
                        const std::vector<assimilation::FilterModel>& trials,
                        std::vector<Refit>& fits) {
  OtherStarts nothing, own;
  const bool far =
      std::fabs(std::log(state.so_far.found.diffusion_ratio)) > std::log(kFarFromModel);
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (!fits[k].failure.empty() || fits[k].deviance > state.so_far.found.deviance)
      nothing.add(k, trials[k]);
    if (!far) continue;
    assimilation::FilterModel start = trials[k];
    start.diffusion_ratio = 1;
    own.add(k, std::move(start));
  }
  if (!nothing.which.empty()) {
    search.tell("  refits that start from strength 0");
    nothing.refit(search, state, trials.size(), fits);
  }
  if (far) {
    search.tell("  refits that start from the model's D");
    own.refit(search, state, trials.size() + nothing.which.size(), fits);
  }
}

// Without what was dropped before.
std::vector<assimilation::FilterModel> trials_of(const Search& search, const SearchState& state) {
  Screening open = state.so_far.rounds.back().screening;
  const auto dropped = [&](const CandidateScore& score) {
    return was_dropped(state.so_far, score.effect);
  };
  open.scores.erase(std::remove_if(open.scores.begin(), open.scores.end(), dropped),
                    open.scores.end());
  std::vector<assimilation::FilterModel> trials;
  const double limit = discrimination_limit(search.values(), open.mesh_error);
  for (assimilation::Hypothesis::Part& part : shortlist(open, search.request().shortlist, limit)) {
    trials.push_back(search.model(state));
    trials.back().hypothesis.parts.push_back(std::move(part));
  }
  return trials;
}

SearchState taken(const Judgement& judgement, SearchState state) {
  Explanation& result = state.so_far;
  const std::vector<Refit>& refits = result.rounds.back().refits;
  result.finding = judgement.finding;
  result.rivals.clear();
  for (std::size_t k = 1; k < refits.size(); ++k)
    if (is_among(judgement.equivalent, refits[k])) result.rivals.push_back(refits[k]);
  set_found(refits.front(), state);
  state.replacements = 0;
  state.next = SearchStep::replace;
  return state;
}

}  // namespace

SearchState screen_candidates(Search& search, SearchState state) {
  const ExplainRequest& request = search.request();
  const assimilation::FilterResult& fields = search.forecasts(state).fields;
  const assimilation::FilterProblems& data = search.data(state);
  Explanation& result = state.so_far;
  result.frames = frame_changes(fields, request);
  result.found_maps = assimilation::disagreement_maps(
      data, fields, data.front().space->surface.position, kMapWidth * request.base.epsilon);
  if (result.rounds.empty()) result.base_maps = result.found_maps;
  const assimilation::FilterModel model = search.model(state);
  Round round{model, screen(fields, model.screened, model.hypothesis), result.found, {}, {}, {}};
  const auto most = static_cast<std::size_t>(request.most_effects);
  const bool more = progresses(search, result) && model.hypothesis.added() < most &&
                    result.rounds.size() < most + kMoreRounds;
  state.next =
      more && round.screening.p <= request.false_alarms ? SearchStep::refit : SearchStep::choose;
  result.rounds.push_back(std::move(round));
  state.eliminated = false;
  return state;
}

SearchState refit_shortlist(Search& search, SearchState state) {
  const std::vector<assimilation::FilterModel> trials = trials_of(search, state);
  search.tell(formatted("%zu refits (gains are 2 ln of the likelihood ratio)", trials.size()));
  std::vector<Refit> fits = search.refit_all(state, trials);
  refit_from_nothing(search, state, trials, fits);
  Round& round = state.so_far.rounds.back();
  for (const Refit& fit : fits)
    if (fit.failure.empty())
      round.refits.push_back(no_worse(fit, round.without));
    else
      round.failures.push_back({last_effect(fit.hypothesis), fit.failure});
  std::sort(round.refits.begin(), round.refits.end(),
            [n = search.values()](const Refit& a, const Refit& b) {
              return criterion(a, n) < criterion(b, n);
            });
  state.next = SearchStep::choose;
  return state;
}

SearchState choose(Search& search, SearchState state) {
  Explanation& result = state.so_far;
  const assimilation::FilterProblems& data = search.data(state);
  const double usual_change =
      kUsualChange * assimilation::contrast_of(data) / assimilation::noise_of(data);
  const Judgement judgement =
      judge(result.rounds.back(), search.values(), search.request().false_alarms, usual_change,
            [&](const Refit& fit) { return leaves_gap(search, state, fit); });
  if (judgement.taken) return taken(judgement, std::move(state));
  result.without_gap =
      judgement.without_gap == Finding::named ? result.finding : judgement.without_gap;
  // A class that could not be told apart before cannot be now.
  if (judgement.finding != Finding::named) result.finding = judgement.finding;
  state.next = judgement.finding == Finding::unnamed && !result.rivals.empty()
                   ? SearchStep::compare_gaps
                   : SearchStep::weigh;
  return state;
}

}  // namespace traceraft::selection
