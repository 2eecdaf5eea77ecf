#include "verification/explain/search/search_round.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"
#include "verification/explain/filter/noise_levels.hpp"
#include "verification/explain/search/class_evidence.hpp"
#include "verification/explain/search/drops.hpp"
#include "verification/explain/search/replacements.hpp"
#include "verification/explain/search/shortlist.hpp"

namespace traceraft {
namespace {

// From one snapshot to the next, in units of the standard deviation of c: what effects are hardly
// looked for below.
constexpr double kUsualChange = 0.06;
// Rounds beyond the most effects, as effects may be replaced or dropped.
constexpr std::size_t kMoreRounds = 3;
// Of means over the neighbourhood, in widths of phase boundaries.
constexpr double kMapWidth = 2;
// Beyond that many standard deviations a snapshot is said to be turned or scaled.
constexpr double kChanged = 3;

void note_changes(Search& search, const FilterResult& pass) {
  const FilterSettings& known = search.request.filter;
  const DoubleWell& well = search.request.base.well;
  search.result.changes.clear();
  for (const Innovation& in : pass.innovations) {
    const auto changed = [&](Eigen::Index k) { return std::fabs(in.frame[k]) >= kChanged; };
    const bool turned = changed(0) || changed(1) || changed(2);
    if (!turned && !changed(3) && !changed(4)) continue;
    const double offset = known.offset * (well.b - well.a);
    search.result.changes.push_back(
        {in.vesicle, in.snapshot, turned ? known.turn * in.frame.head(3).norm() : 0,
         changed(3) ? known.gain * in.frame[3] : 0, changed(4) ? offset * in.frame[4] : 0});
  }
}

void draw_maps(Search& search, const FilterResult& pass, bool first) {
  search.result.found_maps =
      disagreement_maps(search.data, pass, search.data.front().space->surface.position,
                        kMapWidth * search.request.base.epsilon);
  if (first) search.result.base_maps = search.result.found_maps;
}

// First orders of an effect that another D makes up for may lie beyond a ridge, from where the way
// does not lead back: where such refits end worse than without the effect, they begin once more
// with nothing of it.
std::vector<Refit> refit_again(Search& search, const std::vector<FilterModel>& trials,
                               std::vector<Refit> fits) {
  std::vector<FilterModel> again;
  std::vector<std::size_t> which;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (fits[k].failure.empty() && fits[k].deviance <= search.result.found.deviance) continue;
    again.push_back(trials[k]);
    std::vector<double>& coefficients = again.back().hypothesis.parts.back().coefficients;
    coefficients.assign(coefficients.size(), 0);
    which.push_back(k);
  }
  if (again.empty()) return fits;
  search.tell("  from where they do nothing");
  std::vector<Refit> better = search.refit_all(again);
  for (std::size_t k = 0; k < which.size(); ++k)
    if (better[k].failure.empty()) fits[which[k]] = std::move(better[k]);
  return fits;
}

void refit_shortlist(Search& search, Round& round) {
  std::vector<FilterModel> trials;
  const double limit = telling(search.values(), round.screening.mesh_error);
  Screening open = round.screening;
  open.scores.erase(std::remove_if(open.scores.begin(), open.scores.end(),
                                   [&](const CandidateScore& score) {
                                     return was_dropped(search.result, score.effect);
                                   }),
                    open.scores.end());
  for (Hypothesis::Part& part : shortlist(open, search.request.shortlist, limit)) {
    trials.push_back(search.model);
    trials.back().hypothesis.parts.push_back(std::move(part));
  }
  search.tell(
      formatted("%zu refits: 2 ln of the likelihood ratio that an effect gains", trials.size()));
  for (const Refit& fit : refit_again(search, trials, search.refit_all(trials)))
    if (fit.failure.empty())
      round.refits.push_back(no_worse(fit, round.without));
    else
      round.failures.push_back({last_effect(fit.hypothesis), fit.failure});
  std::sort(round.refits.begin(), round.refits.end(),
            [n = search.values()](const Refit& a, const Refit& b) {
              return criterion(a, n) < criterion(b, n);
            });
}

bool leave(Search& search, const Judgement& judgement) {
  if (judgement.finding == Finding::unnamed && leave_to_rivals(search)) return true;
  Explanation& result = search.result;
  result.without_gap =
      judgement.without_gap == Finding::named ? result.finding : judgement.without_gap;
  // What could not be told apart before cannot be now.
  if (judgement.finding != Finding::named) result.finding = judgement.finding;
  return false;
}

bool take(Search& search, const Round& round) {
  const double usual_change = kUsualChange * contrast_of(search.data) / noise_of(search.data);
  const Judgement judgement =
      judge(round, search.values(), search.request.false_alarms, usual_change,
            [&](const Refit& fit) { return leaves_gap(search, fit); });
  if (!judgement.taken) return leave(search, judgement);
  Explanation& result = search.result;
  result.finding = judgement.finding;
  result.rivals.clear();
  for (std::size_t k = 1; k < round.refits.size(); ++k)
    if (is_among(judgement.equivalent, round.refits[k])) result.rivals.push_back(round.refits[k]);
  search.set_found(round.refits.front());
  improve(search);
  return true;
}

// Says what is left. Is it worth while to look for more?
bool progresses(const Search& search) {
  const Explanation& result = search.result;
  if (result.rounds.empty()) return true;
  const Gaps &base = result.base.gap, &now = result.found.gap;
  if (const auto closed = share_closed(base.train, now.train, result.found.expected.train))
    search.tell(formatted("  %.0f %% of the gap is left", 100 * (1 - *closed)));
  const std::optional<double> last = closed_by_last_round(result);
  if (!last || *last >= kLeastProgress) return true;
  search.tell(formatted("  the last round closed %.0f %% of what was left: no more are begun",
                        100 * std::max(0.0, *last)));
  return false;
}

// Nothing was looked at beside what was found.
void stop(Explanation& result, const std::string& why) {
  result.stopped = why;
  result.changes.clear();
  result.found_maps = {};
  if (result.found.hypothesis.added() > 0) return;
  result.rivals.clear();
  result.finding = result.without_gap = Finding::not_identifiable;
}

}  // namespace

bool look_for_one(Search& search) {
  Explanation& result = search.result;
  const bool first = result.rounds.empty();
  search.tell(first ? "what the base model lacks"
                    : "what is lacking beside " + search.model.hypothesis.name());
  FilterResult pass;
  try {
    pass = first ? search.first_pass() : drop_what_is_none(search, search.next_pass());
  } catch (const IoError&) {
    throw;
  } catch (const std::runtime_error& error) {
    if (first) throw;
    stop(result, error.what());
    return false;
  }
  note_changes(search, pass);
  draw_maps(search, pass, first);
  const FilterModel& model = search.model;
  Round round{model, screen(pass, model.screened, model.hypothesis), result.found, {}, {}, {}};
  const auto most = static_cast<std::size_t>(search.request.most_effects);
  const bool more = progresses(search) && model.hypothesis.added() < most &&
                    result.rounds.size() < most + kMoreRounds;
  if (more && round.screening.p <= search.request.false_alarms) refit_shortlist(search, round);
  result.rounds.push_back(std::move(round));
  return take(search, result.rounds.back());
}

}  // namespace traceraft
