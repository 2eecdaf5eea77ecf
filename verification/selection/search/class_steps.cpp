// Members of a class are told apart by the gaps that they leave, and by all that was measured, the
// held-out snapshots included.
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "kernel/core/error.hpp"
#include "verification/selection/search/steps.hpp"

namespace traceraft::selection {
namespace {

bool holds_out(const assimilation::FilterProblems& data) {
  return std::any_of(data.begin(), data.end(), [](const assimilation::FilterProblem& vesicle) {
    return vesicle.train < vesicle.snapshots.size();
  });
}

assimilation::FilterProblems holding_nothing_out(assimilation::FilterProblems data) {
  for (assimilation::FilterProblem& vesicle : data) vesicle.train = vesicle.snapshots.size();
  return data;
}

bool is_open(const Explanation& result) {
  const bool open =
      result.finding == Finding::ambiguous ||
      (result.finding == Finding::unnamed && result.without_gap == Finding::ambiguous);
  return open && result.stopped.empty() && !result.rivals.empty();
}

// The found one is not left for one that is hardly any better (Akaike 1974).
constexpr double kBetter = 2;

// A member of the class, and as it fits all that was measured.
struct Member {
  Refit fit, all;
};

// The most probable one with all that was measured; the first one, if none with effects that are
// resolved is better.
std::size_t best_of(const std::vector<Member>& members, double values, const SearchState& state) {
  // Its gap is that of the found one.
  if (state.so_far.finding == Finding::unnamed) return 0;
  std::size_t best = 0;
  double least = criterion(members.front().all, values) - kBetter;
  for (std::size_t k = 1; k < members.size(); ++k) {
    const Refit& fit = members[k].all;
    if (!fit.failure.empty() || criterion(fit, values) >= least ||
        !all_resolved(fit, values, mesh_error(state)))
      continue;
    least = criterion(fit, values);
    best = k;
  }
  return best;
}

const Refit* refit_in(const Round& round, const Refit& fit) {
  for (const std::vector<Refit>* fits : {&round.refits, &round.moves})
    for (const Refit& one : *fits)
      if (one.hypothesis.name() == fit.hypothesis.name()) return &one;
  return nullptr;
}

// Hypotheses that contain the found one as a special case are no rivals of it, but may be rivals of
// another best one. Only deviances of one round are in units of the same noise.
std::vector<Refit> shadows(const Search& search, const SearchState& state, const Refit& best) {
  const Refit& found = state.so_far.found;
  const double limit = discrimination_limit(search.values(), mesh_error(state));
  std::vector<Refit> result;
  for (const Round& round : state.so_far.rounds) {
    const Refit *own = refit_in(round, found), *other = refit_in(round, best);
    if (own == nullptr || other == nullptr) continue;
    for (const Refit& fit : round.refits)
      if (is_no_other(fit, *own) && !is_among(class_of(state.so_far), fit) &&
          explains_as_well(fit, *other, search.values(), limit))
        result.push_back(fit);
  }
  return result;
}

void fit_all(const std::vector<Refit>& fits, const assimilation::FilterProblems& all,
             const Search& search, std::vector<Member>& members) {
  const ExplainRequest& request = search.request();
  for (const Refit& fit : fits) {
    search.tell("  " + fit.hypothesis.name() + ", fitted to all snapshots");
    members.push_back({fit, refit_of(all, request.base, fit, request.filter)});
  }
}

// The found one first. None if that cannot be refitted.
std::vector<Member> members_of(const assimilation::FilterProblems& all, const Search& search,
                               const SearchState& state) {
  std::vector<Refit> fits{state.so_far.found};
  fits.insert(fits.end(), state.so_far.rivals.begin(), state.so_far.rivals.end());
  std::vector<Member> members;
  fit_all(fits, all, search, members);
  if (!members.front().all.failure.empty()) return {};
  if (const std::size_t best = best_of(members, assimilation::count_values(all), state); best != 0)
    fit_all(shadows(search, state, members[best].fit), all, search, members);
  return members;
}

// Members are rivals of the best one, or excluded, by all that was measured.
void judge_members(const Search& search, const std::vector<Member>& members, std::size_t best,
                   double values, Explanation& result) {
  const double limit = discrimination_limit(values, result.rounds.back().screening.mesh_error);
  result.rivals.clear();
  for (std::size_t k = 0; k < members.size(); ++k) {
    const std::string name = members[k].fit.hypothesis.name();
    if (!members[k].all.failure.empty()) {
      search.tell("  " + name + " fails");
      result.rounds.back().failures.push_back({name, members[k].all.failure});
      result.rivals.push_back(members[k].fit);
      continue;
    }
    const double worse = criterion(members[k].all, values) - criterion(members[best].all, values);
    const long less = std::lround(worse);
    search.tell("  " + name + (less < 0 ? " gains " : " loses ") + std::to_string(std::labs(less)));
    if (worse >= limit)
      result.excluded.push_back({name, worse});
    else if (k != best)
      result.rivals.push_back(members[k].fit);
  }
  if (result.rivals.empty())
    (result.finding == Finding::unnamed ? result.without_gap : result.finding) = Finding::named;
}

// A hypothesis with the noise and the errors that it has, and whether it leaves a gap.
struct Beside {
  Refit fit;
  bool gap;
};

// Nothing if it cannot be forecast with.
std::optional<Beside> beside(Search& search, SearchState state, const Refit& fit) {
  set_found(fit, state);
  try {
    const SearchState there = calibrate_found(search, std::move(state));
    const Screening left =
        screen(search.forecasts(there).fields, search.model(there).screened, fit.hypothesis);
    return Beside{there.so_far.found, has_gap(left, search.request().false_alarms)};
  } catch (const IoError&) {
    throw;
  } catch (const std::runtime_error& error) {
    search.tell("  fails: " + std::string(error.what()));
    return {};
  }
}

}  // namespace

Refit refit_of(const assimilation::FilterProblems& data, const problem::CahnHilliardModel& base,
               const Refit& member, assimilation::FilterSettings settings) {
  settings.replicates = 0;
  const assimilation::FilterModel model{base, member.diffusion_ratio, member.hypothesis, {}};
  try {
    std::vector<assimilation::ErrorMaps> maps;
    (void)assimilation::filter_fields(data, model, settings, maps);
    return refit(data, model, settings, maps);
  } catch (const std::runtime_error& error) {
    Refit failed;
    failed.failure = error.what();
    return failed;
  }
}

bool is_as_probable(Search& search, const SearchState& state, const Refit& one,
                    const Refit& other) {
  const ExplainRequest& request = search.request();
  const assimilation::FilterProblems all = holding_nothing_out(search.data(state));
  const Refit first = refit_of(all, request.base, one, request.filter);
  const Refit second = refit_of(all, request.base, other, request.filter);
  const double values = assimilation::count_values(all);
  return first.failure.empty() && second.failure.empty() &&
         criterion(first, values) <= criterion(second, values);
}

bool leaves_gap(Search& search, const SearchState& state, const Refit& fit) {
  search.tell("search for what is missing from the model with " + fit.hypothesis.name());
  const std::optional<Beside> there = beside(search, state, fit);
  return there && there->gap;
}

SearchState compare_gaps(Search& search, SearchState state) {
  Explanation& result = state.so_far;
  std::vector<Refit> without_gap;
  for (const Refit& rival : result.rivals) {
    search.tell("the same for " + rival.hypothesis.name());
    const std::optional<Beside> there = beside(search, state, rival);
    if (there && !there->gap) without_gap.push_back(there->fit);
  }
  state.next = without_gap.empty() ? SearchStep::weigh : SearchStep::calibrate;
  if (without_gap.empty()) return state;
  result.changes.push_back({ModelChange::left_gap, result.found.hypothesis.name(),
                            without_gap.front().hypothesis.name()});
  set_found(without_gap.front(), state);
  result.rivals.assign(without_gap.begin() + 1, without_gap.end());
  result.finding = finding_beside(result.rivals.size());
  return state;
}

SearchState weigh(Search& search, SearchState state) {
  Explanation& result = state.so_far;
  const bool asked = std::exchange(state.weighed, true);
  state.next = SearchStep::confirm;
  if (asked || !is_open(result) || !holds_out(search.data(state))) return state;
  search.tell("compare the members of the class on the held-out snapshots");
  const assimilation::FilterProblems all = holding_nothing_out(search.data(state));
  const std::vector<Member> members = members_of(all, search, state);
  if (members.empty()) return state;
  const double values = assimilation::count_values(all);
  const std::size_t best = best_of(members, values, state);
  judge_members(search, members, best, values, result);
  if (best == 0) return state;
  result.changes.push_back({ModelChange::foretold, members.front().fit.hypothesis.name(),
                            members[best].fit.hypothesis.name()});
  set_found(members[best].fit, state);
  state.next = SearchStep::calibrate;
  return state;
}

}  // namespace traceraft::selection
