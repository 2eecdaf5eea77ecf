#include "verification/explain/search/drops.hpp"

#include <algorithm>
#include <optional>

#include "kernel/core/text.hpp"
#include "verification/explain/search/class_evidence.hpp"

namespace traceraft {
namespace {

Hypothesis without(Hypothesis hypothesis, const std::string& effect) {
  auto& parts = hypothesis.parts;
  parts.erase(std::remove_if(parts.begin(), parts.end(),
                             [&](const auto& part) { return part.candidate.effect == effect; }),
              parts.end());
  return hypothesis;
}

struct Drop {
  std::string effect;
  Refit rest;
};

// The most probable refit without an effect that is not resolved.
std::optional<Drop> what_is_none(Search& search, double mesh_error) {
  const Refit& found = search.result.found;
  std::vector<std::string> doubtful;
  std::vector<FilterModel> trials;
  for (std::size_t k = found.hypothesis.known; k < found.hypothesis.parts.size(); ++k) {
    if (resolved(found, k, search.values(), mesh_error)) continue;
    doubtful.push_back(found.hypothesis.parts[k].candidate.effect);
    trials.push_back(search.model);
    trials.back().hypothesis = without(found.hypothesis, doubtful.back());
  }
  if (trials.empty()) return {};
  search.tell("without " + joined(doubtful, ", or without "));
  const std::vector<Refit> fits = search.refit_all(trials);
  std::optional<Drop> best;
  double least = criterion(found, search.values());
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (!fits[k].failure.empty() || criterion(fits[k], search.values()) > least) continue;
    least = criterion(fits[k], search.values());
    best = Drop{doubtful[k], fits[k]};
  }
  // What is held out may tell that there is one.
  return best && is_as_probable(search, best->rest, found) ? best : std::nullopt;
}

void refit_rivals(Search& search, double mesh_error) {
  Explanation& result = search.result;
  std::vector<FilterModel> trials;
  std::vector<std::string> tried{result.found.hypothesis.name()};
  for (const Refit& rival : result.rivals) {
    FilterModel trial = search.model;
    trial.hypothesis = rival.hypothesis;
    trial.pace = rival.pace;
    for (const Turn& turn : result.turns)
      if (turn.why == Turn::is_none) trial.hypothesis = without(trial.hypothesis, turn.from);
    const std::string name = trial.hypothesis.name();
    if (name.empty() || std::count(tried.begin(), tried.end(), name) > 0) continue;
    tried.push_back(name);
    trials.push_back(std::move(trial));
  }
  result.rivals.clear();
  const double limit = telling(search.values(), mesh_error);
  for (Refit& fit : search.refit_all(trials))
    if (fit.failure.empty() && explains_as_well(fit, result.found, search.values(), limit))
      result.rivals.push_back(std::move(fit));
  result.finding = result.rivals.empty() ? Finding::named : Finding::ambiguous;
}

}  // namespace

FilterResult drop_what_is_none(Search& search, FilterResult pass) {
  Explanation& result = search.result;
  const auto mesh_error = [&] { return screen(pass, {}, search.model.hypothesis).mesh_error; };
  bool dropped = false;
  while (const auto drop = what_is_none(search, mesh_error())) {
    search.tell("  " + drop->effect + " is none");
    result.turns.push_back({Turn::is_none, drop->effect, drop->rest.hypothesis.name()});
    search.set_found(drop->rest);
    pass = search.next_pass();
    dropped = true;
  }
  if (dropped) refit_rivals(search, mesh_error());
  return pass;
}

bool was_dropped(const Explanation& result, const std::string& effect) {
  return std::any_of(result.turns.begin(), result.turns.end(), [&](const Turn& turn) {
    return turn.why == Turn::is_none && turn.from == effect;
  });
}

}  // namespace traceraft
