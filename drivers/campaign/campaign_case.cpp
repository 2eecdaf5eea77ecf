#include "drivers/campaign/campaign_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "drivers/campaign/hidden_case.hpp"
#include "drivers/explain/explain_report.hpp"
#include "drivers/explain/explain_run.hpp"
#include "drivers/output/json_file.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/random.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/effects/effects.hpp"
#include "verification/explain/rerun.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// Equal for a case wherever it is carried out: its name's hash by FNV-1a (Fowler, Noll, Vo), whose
// high bits are the good ones. A double holds it.
std::uint64_t seed_of(const CampaignPlan& plan, const CaseId& id) {
  std::uint64_t hash = 14695981039346656037ULL ^ plan.seed;
  for (const char ch : "case " + id.name())
    hash = (hash ^ static_cast<unsigned char>(ch)) * 1099511628211ULL;
  return hash >> 11;
}

void draw(const fs::path& folder, const CampaignPlan& plan, const CaseSettings& settings,
          std::uint64_t seed) {
  const Configuration model(plan.model, {});
  BlindRequest request;
  request.effects = settings.hidden;
  request.noise = settings.noise;
  request.stated = settings.stated;
  request.snapshots = settings.snapshots;
  request.points = plan.points;
  request.pace = std::exp(0.4 * (uniform_random(seed, 2, 0) - 0.5));
  request.cells = truth_cells(plan.model);
  request.seed = seed;
  request.threads = 1;
  GivenValues given = plan.model;
  const auto cells = std::lround(settings.coarser * static_cast<double>(model.integer("cells")));
  given["cells"] = {std::to_string(cells), "campaign"};
  hide(folder, given, request);
}

std::string names_of(const std::vector<EffectTerm>& terms) {
  std::string names;
  for (const EffectTerm& term : terms) names += (names.empty() ? "" : " + ") + term.effect;
  return names;
}

std::vector<std::string> sorted_parts(const std::string& names) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < names.size();) {
    const std::size_t end = std::min(names.find(" + ", at), names.size());
    parts.push_back(names.substr(at, end - at));
    at = end + 3;
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

CaseOutcome outcome_of(const CampaignGroup& group, const HiddenTruth& truth, const Json& verdict) {
  const std::string word = verdict.at("verdict");
  const bool named = !verdict.at("effect").is_null();
  if (group.aim == Aim::nothing)
    return named || word == "unnamed" ? CaseOutcome::wrong
           : word == "none"           ? CaseOutcome::right
                                      : CaseOutcome::missed;
  if (group.aim == Aim::unnamed)
    return named               ? CaseOutcome::wrong
           : word == "unnamed" ? CaseOutcome::right
                               : CaseOutcome::missed;
  if (!named) return CaseOutcome::missed;
  const auto hidden = sorted_parts(names_of(truth.effects));
  const std::vector<std::string> found = sorted_parts(verdict.at("effect"));
  if (found == hidden) return word == "named" ? CaseOutcome::right : CaseOutcome::in_class;
  for (const std::string equivalent : verdict.at("class"))
    if (sorted_parts(equivalent) == hidden) return CaseOutcome::in_class;
  // A part of what was hidden, and nothing else, is no wrong name.
  return std::includes(hidden.begin(), hidden.end(), found.begin(), found.end())
             ? CaseOutcome::missed
             : CaseOutcome::wrong;
}

// How far the first hidden effect's strength is off, if it was named.
void score_strength(const HiddenTruth& truth, const GivenValues& model, const Json& verdict,
                    Json& score) {
  score["error"] = score["deviations"] = nullptr;
  if (truth.effects.empty() || verdict.at("effect").is_null()) return;
  const EffectTerm& term = truth.effects.front();
  const ParameterSpec& strength = effects().find(term.effect).parameters.front();
  const auto found = verdict.at("parameters").find(term.effect + "." + strength.name);
  if (found == verdict.at("parameters").end()) return;
  Units units = Configuration(model, {}).units();
  units.diffusion_cm2_s *= truth.pace;
  const double value = term.values.front() / to_model_units(strength.unit, units);
  const double difference = found->at("value").get<double>() - value;
  score["error"] = std::fabs(difference / value);
  score["deviations"] = difference / found->at("sigma").get<double>();
}

void write_score(const CampaignFolder& folder, const CampaignGroup& group, const CaseId& id,
                 const ExplainSetup& setup, double seconds) {
  const HiddenTruth truth = open_truth(folder.of(id));
  const Gaps floor = gaps_of_model(setup.series, setup.request, truth.pace, truth.effects).gap;
  const Json score = from_json(folder.of(id) / "explain" / "verdict.json", [&](const Json& v) {
    const auto heldout = [&](const char* which) { return v.at("gap").at(which).at("heldout"); };
    Json json = {{"hidden", names_of(truth.effects)},
                 {"verdict", v.at("verdict")},
                 {"effect", v.at("effect").is_null() ? Json("") : v.at("effect")},
                 {"class", v.at("class")},
                 {"outcome", word_for(outcome_of(group, truth, v))},
                 {"p", v.at("null").at("p")},
                 {"rounds", v.at("null").at("rounds")},
                 {"heldout",
                  {{"base", heldout("base")},
                   {"named", heldout("named")},
                   {"placebo", heldout("placebo")},
                   {"floor", floor.heldout > 0 ? Json(floor.heldout) : Json()}}},
                 {"seconds", seconds}};
    score_strength(truth, setup.model, v, json);
    return json;
  });
  write_durably(folder.score_of(id), score.dump(2) + "\n");
}

}  // namespace

std::string word_for(CaseOutcome outcome) {
  switch (outcome) {
    case CaseOutcome::right:
      return "right";
    case CaseOutcome::in_class:
      return "in class";
    case CaseOutcome::missed:
      return "missed";
    case CaseOutcome::wrong:
      return "wrong";
  }
  return "";
}

CaseOutcome outcome_of(const std::string& word) {
  for (const CaseOutcome outcome :
       {CaseOutcome::right, CaseOutcome::in_class, CaseOutcome::missed, CaseOutcome::wrong})
    if (word == word_for(outcome)) return outcome;
  throw InputError("a case of a campaign cannot end with '" + word + "'");
}

void carry_out_case(const CampaignFolder& folder, const CampaignPlan& plan, const CaseId& id) {
  const CampaignGroup& group = campaign_groups().find(id.group);
  const fs::path path = folder.of(id);
  const std::uint64_t seed = seed_of(plan, id);
  const CaseSettings settings = settings_of(group, id.number, seed);
  if (!fs::exists(path / "model.toml")) draw(path, plan, settings, seed);

  const Stopwatch watch;
  ExplainJob job;
  job.data = path / "data";
  job.model = path / "model.toml";
  job.threads = 1;
  job.replicates = plan.replicates;
  job.effects = plan.effects;
  job.without = settings.without;
  ExplainSetup setup = read_explain_job(job);
  if (!fs::exists(path / "explain" / "verdict.json")) {
    fs::create_directories(path / "explain");
    write_explanation(path / "explain", explain_fields(setup.series, setup.request), setup.model);
  }
  write_score(folder, group, id, setup, watch.seconds());
}

CaseScore read_score(const CampaignFolder& folder, const CaseId& id) {
  return from_json(folder.score_of(id), [&](const Json& json) {
    const auto number = [](const Json& value) {
      return value.is_null() ? kNothing : value.get<double>();
    };
    const Json& heldout = json.at("heldout");
    return CaseScore{id,
                     json.at("hidden"),
                     json.at("verdict"),
                     json.at("effect"),
                     outcome_of(json.at("outcome")),
                     number(json.at("error")),
                     number(json.at("deviations")),
                     number(json.at("p")),
                     number(heldout.at("base")),
                     number(heldout.at("named")),
                     number(heldout.at("placebo")),
                     number(heldout.at("floor")),
                     number(json.at("seconds"))};
  });
}

}  // namespace traceraft
