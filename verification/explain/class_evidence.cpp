#include "verification/explain/class_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace traceraft {
namespace {

std::optional<double> criterion_of(const FilterProblems& data, FilterModel model,
                                   const FilterSettings& settings) {
  try {
    std::vector<ErrorMaps> maps;
    (void)filter_fields(data, model, settings, maps);
    const Refit fit = refit(data, model, settings, maps);
    if (!fit.failure.empty()) return {};
    return criterion(fit, count_values(data));
  } catch (const std::runtime_error&) {
    return {};
  }
}

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

// By how much each member's criterion is worse than the best one's; 0 where it is not known.
struct Comparison {
  std::size_t best;
  std::vector<double> worse;
};

std::optional<Comparison> compare(const FilterProblems& all, const std::vector<Refit>& members,
                                  const Search& search) {
  const auto criteria = criteria_of(all, search.request.base, members, search.request.filter);
  if (!criteria.front()) return {};
  Comparison result{0, {}};
  for (std::size_t k = 1; k < members.size(); ++k)
    if (criteria[k] && *criteria[k] < *criteria[result.best]) result.best = k;
  // Its gap is that of the found one.
  if (search.result.finding == Finding::unnamed) result.best = 0;
  for (const auto& own : criteria) result.worse.push_back(own ? *own - *criteria[result.best] : 0);
  return result;
}

}  // namespace

std::vector<std::optional<double>> criteria_of(const FilterProblems& data,
                                               const CahnHilliardModel& base,
                                               const std::vector<Refit>& members,
                                               FilterSettings settings) {
  settings.replicates = 0;
  std::vector<std::optional<double>> criteria;
  for (const Refit& member : members)
    criteria.push_back(criterion_of(data, {base, member.pace, member.hypothesis, {}}, settings));
  return criteria;
}

bool is_as_probable(const Search& search, const Refit& one, const Refit& other) {
  const auto criteria = criteria_of(holding_nothing_out(search.data), search.request.base,
                                    {one, other}, search.request.filter);
  return criteria[0] && criteria[1] && *criteria[0] <= *criteria[1];
}

bool leave_to_rivals(Search& search) {
  const SearchState before = search.state(true);
  std::vector<Refit> without_gap;
  for (const Refit& rival : before.so_far.rivals) {
    search.tell("instead " + rival.hypothesis.name());
    search.go_on_from(before);
    search.set_found(rival);
    try {
      const FilterResult pass = search.next_pass();
      const Screening left = screen(pass, search.model.screened, search.model.hypothesis);
      if (!has_gap(left, search.request.false_alarms)) without_gap.push_back(search.result.found);
    } catch (const std::runtime_error& error) {
      search.tell("  fails: " + std::string(error.what()));
    }
  }
  search.go_on_from(before);
  if (without_gap.empty()) return false;
  search.set_found(without_gap.front());
  Explanation& result = search.result;
  result.rivals.assign(without_gap.begin() + 1, without_gap.end());
  result.finding = result.rivals.empty() ? Finding::named : Finding::ambiguous;
  return true;
}

bool tell_apart(Search& search) {
  Explanation& result = search.result;
  search.told_apart = true;
  if (!is_open(result) || !holds_out(search.data)) return false;
  search.tell("what is held out says of the class");
  std::vector<Refit> members{result.found};
  members.insert(members.end(), result.rivals.begin(), result.rivals.end());
  const FilterProblems all = holding_nothing_out(search.data);
  const auto compared = compare(all, members, search);
  if (!compared) return false;
  const double limit = telling(count_values(all), search.mesh_error());
  result.rivals.clear();
  for (std::size_t k = 0; k < members.size(); ++k) {
    const double worse = compared->worse[k];
    search.tell("  " + members[k].hypothesis.name() +
                (k == compared->best ? std::string(" explains most")
                                     : " loses " + std::to_string(std::lround(worse))));
    if (worse >= limit)
      result.told_apart.push_back({members[k].hypothesis.name(), worse});
    else if (k != compared->best)
      result.rivals.push_back(members[k]);
  }
  if (result.rivals.empty())
    (result.finding == Finding::unnamed ? result.without_gap : result.finding) = Finding::named;
  if (compared->best == 0) return false;
  search.set_found(members[compared->best]);
  return true;
}

}  // namespace traceraft
