#include "verification/explain/search/class_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

bool holds_out(const FilterProblems& data) {
  return std::any_of(data.begin(), data.end(), [](const FilterProblem& vesicle) {
    return vesicle.train < vesicle.snapshots.size();
  });
}

FilterProblems holding_nothing_out(FilterProblems data) {
  for (FilterProblem& vesicle : data) vesicle.train = vesicle.snapshots.size();
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
std::size_t best_of(const std::vector<Member>& members, double values, const Search& search) {
  // Its gap is that of the found one.
  if (search.result.finding == Finding::unnamed) return 0;
  std::size_t best = 0;
  double least = criterion(members.front().all, values) - kBetter;
  for (std::size_t k = 1; k < members.size(); ++k) {
    const Refit& fit = members[k].all;
    if (!fit.failure.empty() || criterion(fit, values) >= least ||
        !all_resolved(fit, values, search.mesh_error()))
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

// What is no other hypothesis than the found one, of which it has a special case, but may be one
// beside another best. Only deviances of one round are in units of the same noise.
std::vector<Refit> shadows(const Search& search, const Refit& best) {
  const Refit& found = search.result.found;
  const double limit = telling(search.values(), search.mesh_error());
  std::vector<Refit> result;
  for (const Round& round : search.result.rounds) {
    const Refit *own = refit_in(round, found), *other = refit_in(round, best);
    if (own == nullptr || other == nullptr) continue;
    for (const Refit& fit : round.refits)
      if (is_no_other(fit, *own) && !is_among(class_of(search.result), fit) &&
          explains_as_well(fit, *other, search.values(), limit))
        result.push_back(fit);
  }
  return result;
}

void weigh(const std::vector<Refit>& fits, const FilterProblems& all, const Search& search,
           std::vector<Member>& members) {
  for (const Refit& fit : fits) {
    search.tell("  " + fit.hypothesis.name() + ", with all that was measured");
    members.push_back({fit, refit_of(all, search.request.base, fit, search.request.filter)});
  }
}

// The found one first. None if that cannot be refitted.
std::vector<Member> members_of(const FilterProblems& all, const Search& search) {
  std::vector<Refit> fits{search.result.found};
  fits.insert(fits.end(), search.result.rivals.begin(), search.result.rivals.end());
  std::vector<Member> members;
  weigh(fits, all, search, members);
  if (!members.front().all.failure.empty()) return {};
  if (const std::size_t best = best_of(members, count_values(all), search); best != 0)
    weigh(shadows(search, members[best].fit), all, search, members);
  return members;
}

// What a hypothesis leaves, with the noise and the errors that it has.
struct Beside {
  Refit fit;
  bool gap;
};

// Nothing if it cannot be forecast with. The search is then what it was, but for the maps of its
// forecasts.
std::optional<Beside> beside_it(Search& search, const Refit& fit) {
  const SearchState before = search.state(true);
  std::optional<Beside> beside;
  search.set_found(fit);
  try {
    const FilterResult pass = search.next_pass();
    const Screening left = screen(pass, search.model.screened, search.model.hypothesis);
    beside = {search.result.found, has_gap(left, search.request.false_alarms)};
  } catch (const IoError&) {
    throw;
  } catch (const std::runtime_error& error) {
    search.tell("  fails: " + std::string(error.what()));
  }
  search.go_on_from(before);
  return beside;
}

}  // namespace

Refit refit_of(const FilterProblems& data, const CahnHilliardModel& base, const Refit& member,
               FilterSettings settings) {
  settings.replicates = 0;
  const FilterModel model{base, member.pace, member.hypothesis, {}};
  try {
    std::vector<ErrorMaps> maps;
    (void)filter_fields(data, model, settings, maps);
    return refit(data, model, settings, maps);
  } catch (const std::runtime_error& error) {
    Refit failed;
    failed.failure = error.what();
    return failed;
  }
}

bool is_as_probable(const Search& search, const Refit& one, const Refit& other) {
  const FilterProblems all = holding_nothing_out(search.data);
  const Refit first = refit_of(all, search.request.base, one, search.request.filter);
  const Refit second = refit_of(all, search.request.base, other, search.request.filter);
  const double values = count_values(all);
  return first.failure.empty() && second.failure.empty() &&
         criterion(first, values) <= criterion(second, values);
}

bool leaves_gap(Search& search, const Refit& fit) {
  search.tell("what is lacking beside " + fit.hypothesis.name());
  const std::optional<Beside> beside = beside_it(search, fit);
  return beside && beside->gap;
}

bool leave_to_rivals(Search& search) {
  std::vector<Refit> without_gap;
  for (const Refit& rival : std::vector<Refit>(search.result.rivals)) {
    search.tell("instead " + rival.hypothesis.name());
    const std::optional<Beside> beside = beside_it(search, rival);
    if (beside && !beside->gap) without_gap.push_back(beside->fit);
  }
  if (without_gap.empty()) return false;
  Explanation& result = search.result;
  result.turns.push_back(
      {Turn::left_gap, result.found.hypothesis.name(), without_gap.front().hypothesis.name()});
  search.set_found(without_gap.front());
  result.rivals.assign(without_gap.begin() + 1, without_gap.end());
  result.finding = result.rivals.empty() ? Finding::named : Finding::ambiguous;
  return true;
}

bool tell_apart(Search& search) {
  Explanation& result = search.result;
  search.told_apart = true;
  if (!is_open(result) || !holds_out(search.data)) return false;
  search.tell("what is held out says of the class");
  const FilterProblems all = holding_nothing_out(search.data);
  const std::vector<Member> members = members_of(all, search);
  if (members.empty()) return false;
  const double values = count_values(all), limit = telling(values, search.mesh_error());
  const std::size_t best = best_of(members, values, search);
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
      result.told_apart.push_back({name, worse});
    else if (k != best)
      result.rivals.push_back(members[k].fit);
  }
  if (result.rivals.empty())
    (result.finding == Finding::unnamed ? result.without_gap : result.finding) = Finding::named;
  if (best == 0) return false;
  result.turns.push_back(
      {Turn::foretold, members.front().fit.hypothesis.name(), members[best].fit.hypothesis.name()});
  search.set_found(members[best].fit);
  return true;
}

}  // namespace traceraft
