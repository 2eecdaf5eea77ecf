#include "drivers/explain/series_plan.hpp"

#include <algorithm>

#include "drivers/config/config_file.hpp"
#include "drivers/explain/disc_plan.hpp"
#include "drivers/input/json_members.hpp"
#include "drivers/input/measured_units.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/run/physical_model.hpp"
#include "kernel/core/error.hpp"
#include "verification/assimilation/forecast/candidates.hpp"
#include "verification/selection/blind/effect_size.hpp"

namespace traceraft::explain {
namespace {

namespace fs = std::filesystem;

constexpr char kStrengths[] = "strengths.json", kLevels[] = "levels";

// The model and the looks that simulations are for.
input::Json header_of(const config::Configuration& model, const statistics::Window& looks) {
  return {{"identity", config::numerical_identity(ensemble_model(model, "", looks.end))},
          {"looks", {looks.begin, looks.end}}};
}

bool is_for(const input::Json& json, const input::Json& header, const char* key) {
  return json.value(key, input::Json()) == header[key];
}

// The strengths that were found before; empty if there are none.
input::Json saved_levels(const fs::path& file, const input::Json& header) {
  if (!fs::exists(file)) return input::Json::object();
  return input::from_json(file, [&](const input::Json& json) {
    if (!is_for(json, header, "identity") || !is_for(json, header, "looks"))
      throw InputError(file.parent_path().string() +
                       " holds simulations of another model, of an earlier version or for other "
                       "observation times; choose another --out or --ensembles");
    const input::Json levels = json.at(kLevels);
    if (!levels.is_object()) throw DamagedFile("its levels are no object");
    return levels;
  });
}

// The parameters of an effect as a file has them, in units of R and R²/D.
effects::EffectTerm saved_term(const std::string& where, const std::string& effect,
                               const input::Json& json, const physics::Units& units) {
  const effects::EffectEntry& entry = effects::effects().find(effect);
  const std::vector<ParameterSpec>& specs = entry.parameters;
  if (!json.is_array() || json.size() != specs.size() ||
      !std::all_of(json.begin(), json.end(), [](const input::Json& x) { return x.is_number(); }))
    throw DamagedFile(where + " is damaged: " + std::to_string(specs.size()) +
                      " numbers are needed");
  effects::EffectTerm term{effect, {}};
  for (std::size_t k = 0; k < specs.size(); ++k) {
    const double factor = effects::to_model_units(specs[k].unit, units);
    term.values.push_back(json[k].get<double>());
    // A strength that no range reaches is drawn back into it later.
    const bool strength = k < static_cast<std::size_t>(entry.strengths);
    input::check_value(where, term.values[k] / (strength ? 1 : factor),
                       strength ? input::WithinRange{-input::kAnyNumber, input::kAnyNumber}
                                : input::WithinRange{specs[k].min, specs[k].max});
  }
  return term;
}

PlannedEffect saved_effect(const fs::path& file, const std::string& effect, const input::Json& json,
                           const physics::Units& units) {
  const std::string where = file.string() + ": levels." + effect;
  if (!json.is_array() || json.empty()) throw DamagedFile(where + " is damaged: it has no levels");
  PlannedEffect planned;
  for (const input::Json& level : json)
    planned.levels.push_back(saved_term(where, effect, level, units));
  return planned;
}

selection::BlindRequest sizing_request(const config::Configuration& model,
                                       const SeriesPlanRequest& request) {
  const double time = model.units().time();
  selection::BlindRequest sizing;
  sizing.base = run::physical_model(model);
  sizing.raft_fraction = model.options().raft_fraction;
  sizing.cells = static_cast<int>(model.options().cells);
  sizing.initial = model.options().initial;
  sizing.noise_cells = model.options().noise_cells;
  sizing.first = request.looks.begin / time;
  sizing.last = request.looks.end / time;
  sizing.snapshots = 5;
  sizing.threads = request.threads;
  return sizing;
}

// Brownian flow is for discs: fields with enough vesicles would take days.
std::vector<std::string> forecast_effects() {
  std::vector<std::string> names = selection::effects_to_hide();
  const auto random = [](const std::string& name) {
    return assimilation::find_candidate(name)->random;
  };
  names.erase(std::remove_if(names.begin(), names.end(), random), names.end());
  return names;
}

// The strengths of effects on a field, from one simulation of the base.
class FieldSizes {
 public:
  FieldSizes(const config::Configuration& model, const SeriesPlanRequest& request)
      : request_(sizing_request(model, request)), effects_(forecast_effects()) {}

  const std::vector<std::string>& effects() const { return effects_; }

  // Series are held against one mixture of the coefficients of an effect that has two. That is
  // exchange, with the target that keeps the mean where it is: what moves the mean is uptake.
  std::optional<PlannedEffect> find(std::size_t k) {
    if (!sizing_) sizing_.emplace(request_);
    const assimilation::Candidate candidate = *assimilation::find_candidate(effects_[k]);
    if (candidate.directions == 1) return PlannedEffect{{sizing_->term(effects_[k], k)}};
    const double mean = request_.raft_fraction;
    return PlannedEffect{
        {sizing_->term(effects_[k], {candidate.step * (1 - mean), candidate.step * mean})}};
  }

 private:
  const selection::BlindRequest request_;
  const std::vector<std::string> effects_;
  std::optional<selection::EffectSizing> sizing_;
};

input::Json levels_json(const PlannedEffect& planned) {
  input::Json levels = input::Json::array();
  for (const effects::EffectTerm& term : planned.levels) levels.push_back(term.values);
  return levels;
}

// `Sizes`: those of fields or of discs.
template <class Sizes>
std::optional<std::vector<PlannedEffect>> plan_with(Sizes sizes, const fs::path& folder,
                                                    const config::Configuration& model,
                                                    const SeriesPlanRequest& request) {
  const problem::CahnHilliardModel base = run::model_without_effects(model);
  const fs::path file = folder / kStrengths;
  input::Json saved = header_of(model, request.looks);
  input::Json& levels = saved[kLevels] = saved_levels(file, saved);
  std::vector<PlannedEffect> plan;
  for (std::size_t k = 0; k < sizes.effects().size(); ++k) {
    const std::string& effect = sizes.effects()[k];
    if (std::count(request.without.begin(), request.without.end(), effect) > 0 ||
        (effects::effects().find(effect).unit_wells && !effects::has_unit_wells(base)))
      continue;
    if (!levels.contains(effect)) {
      request.tell("sizing the strength of " + effect);
      const std::optional<PlannedEffect> found = sizes.find(k);
      if (!found) return std::nullopt;
      levels[effect] = levels_json(*found);
      input::write_json(file, saved);
    }
    plan.push_back(saved_effect(file, effect, levels.at(effect), model.units()));
  }
  if (plan.empty()) throw InputError("--without: no effect is left to search for");
  return plan;
}

}  // namespace

std::size_t PlannedEffect::sought() const {
  const std::vector<double>& values = levels.front().values;
  const auto strengths = values.begin() + effects::effects().find(levels.front().effect).strengths;
  const auto found = std::find_if(values.begin(), strengths, [](double x) { return x != 0; });
  return found == strengths ? 0 : static_cast<std::size_t>(found - values.begin());
}

std::optional<std::vector<PlannedEffect>> plan_effects(const fs::path& folder,
                                                       const config::Configuration& model,
                                                       const SeriesPlanRequest& request) {
  if (!run::is_of_discs(model))
    return plan_with(FieldSizes(model, request), folder, model, request);
  auto plan = plan_with(DiscSizes(model, request), folder, model, request);
  if (plan)
    for (PlannedEffect& planned : *plan) planned.typical = typical_level(planned, model, request);
  return plan;
}

statistics::Window planned_looks(const fs::path& folder, const config::Configuration& model) {
  const fs::path file = folder / kStrengths;
  return input::from_json(file, [&](const input::Json& json) {
    if (!json.contains("looks") || !json.contains(kLevels))
      throw InputError("--ensembles: " + folder.string() + " was written by an earlier version");
    const statistics::Window looks{json.at("looks").at(0), json.at("looks").at(1)};
    if (!(looks.begin > 0 && looks.begin < looks.end && looks.end <= input::kAnyNumber))
      throw InputError(file.string() + ": looks: two times are needed, the second after the first");
    if (!is_for(json, header_of(model, looks), "identity"))
      throw InputError("--ensembles: " + folder.string() +
                       " holds simulations of another model or of an earlier version");
    return looks;
  });
}

bool has_plan(const fs::path& folder) {
  return fs::exists(folder / kStrengths);
}

config::Configuration ensemble_model(const config::Configuration& model, const std::string& effect,
                                     double t_end) {
  config::GivenValues given = ensemble::settings_until(model, t_end);
  given["case"] = {model.options().case_name, "--case"};
  given["effect"] = {effect, "--effect"};
  return {{}, given};
}

}  // namespace traceraft::explain
