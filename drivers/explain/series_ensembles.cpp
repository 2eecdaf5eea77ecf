#include "drivers/explain/series_ensembles.hpp"

#include <algorithm>
#include <optional>

#include "backends/posix/process.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/ensemble/ensemble_folder.hpp"
#include "drivers/ensemble/ensemble_point.hpp"
#include "drivers/explain/explain_run.hpp"
#include "drivers/explain/found_parameters.hpp"
#include "drivers/input/json_members.hpp"
#include "drivers/input/measured_units.hpp"
#include "drivers/numerical_failure.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/run/physical_model.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "kernel/effects/effects.hpp"
#include "verification/assimilation/forecast/candidates.hpp"
#include "verification/selection/blind/effect_size.hpp"

namespace traceraft::explain {
namespace {

namespace fs = std::filesystem;

// The fastest D over that of the model: runs last as long as if it were that.
constexpr double kFastestDiffusionRatio = 4;

void tell(const SeriesEnsemblesRequest& request, const std::string& step) {
  if (request.quiet) return;
  text::say("%s\n", step);
  text::flush_output();
}

config::Configuration ensemble_model(const config::Configuration& model, const std::string& effect,
                                     double t_end) {
  config::GivenValues given = ensemble::settings_until(model, t_end);
  given["case"] = {model.options().case_name, "--case"};
  given["effect"] = {effect, "--effect"};
  return {{}, given};
}

selection::BlindRequest sizing_request(const config::Configuration& model,
                                       const SeriesEnsemblesRequest& request) {
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

// Series are held against one mixture of the coefficients of an effect that has two. That is
// exchange, with the target that keeps the mean where it is: what moves the mean is uptake.
effects::EffectTerm sized_term(const selection::EffectSizing& sizing, const std::string& effect,
                               std::uint64_t number, double mean) {
  const assimilation::Candidate candidate = *assimilation::find_candidate(effect);
  if (candidate.directions == 1) return sizing.term(effect, number);
  return sizing.term(effect, {candidate.step * (1 - mean), candidate.step * mean});
}

constexpr char kStrengths[] = "strengths.json";

// The model and the looks that simulations are for.
input::Json header_of(const config::Configuration& model, const statistics::Window& looks) {
  return {{"identity", config::numerical_identity(ensemble_model(model, "", looks.end))},
          {"looks", {looks.begin, looks.end}}};
}

bool is_for(const input::Json& json, const input::Json& header, const char* key) {
  return json.value(key, input::Json()) == header[key];
}

// The strengths that were found before; empty if there are none.
input::Json saved_strengths(const fs::path& file, const input::Json& header) {
  if (!fs::exists(file)) return input::Json::object();
  return input::from_json(file, [&](const input::Json& json) {
    if (!is_for(json, header, "identity") || !is_for(json, header, "looks"))
      throw InputError(file.parent_path().string() +
                       " holds simulations of another model, of an earlier version or for other "
                       "observation times; choose another --out or --ensembles");
    const input::Json strengths = json.at("strengths");
    if (!strengths.is_object()) throw DamagedFile("its strengths are no object");
    return strengths;
  });
}

// The parameters of an effect as a file has them, in units of R and R²/D.
effects::EffectTerm saved_term(const fs::path& file, const std::string& effect,
                               const input::Json& json, const physics::Units& units) {
  const std::vector<ParameterSpec>& specs = effects::effects().find(effect).parameters;
  const std::string where = file.string() + ": strengths." + effect;
  if (!json.is_array() || json.size() != specs.size() ||
      !std::all_of(json.begin(), json.end(), [](const input::Json& x) { return x.is_number(); }))
    throw DamagedFile(where + " is damaged: " + std::to_string(specs.size()) +
                      " numbers are needed");
  effects::EffectTerm term{effect, {}};
  for (std::size_t k = 0; k < specs.size(); ++k) {
    const double factor = effects::to_model_units(specs[k].unit, units);
    term.values.push_back(json[k].get<double>());
    // A strength that no range reaches is drawn back into it later.
    if (k > 0)
      input::check_value(where, term.values[k] / factor,
                         input::WithinRange{specs[k].min, specs[k].max});
  }
  input::check_value(where, term.values.front(),
                     input::WithinRange{-input::kAnyNumber, input::kAnyNumber});
  return term;
}

// The strengths of all effects, each found once.
std::vector<effects::EffectTerm> sizes(const fs::path& folder, const config::Configuration& model,
                                       const SeriesEnsemblesRequest& request) {
  const fs::path file = folder / kStrengths;
  input::Json saved = header_of(model, request.looks);
  input::Json& strengths = saved["strengths"] = saved_strengths(file, saved);
  const selection::BlindRequest asked = sizing_request(model, request);
  std::optional<selection::EffectSizing> sizing;
  std::vector<effects::EffectTerm> terms;
  const std::vector<std::string> known = selection::effects_to_hide();
  for (std::size_t k = 0; k < known.size(); ++k) {
    const std::string& effect = known[k];
    if (std::count(request.without.begin(), request.without.end(), effect) > 0 ||
        (effects::effects().find(effect).unit_wells && !effects::has_unit_wells(asked.base)))
      continue;
    if (!strengths.contains(effect)) {
      tell(request, "sizing the strength of " + effect);
      if (!sizing) sizing.emplace(asked);
      strengths[effect] = sized_term(*sizing, effect, k, asked.raft_fraction).values;
      posix::write_durably(file, input::checked_text(saved));
    }
    terms.push_back(saved_term(file, effect, strengths.at(effect), model.units()));
  }
  if (terms.empty()) throw InputError("--without: no effect is left to search for");
  return terms;
}

// "asymmetry, strength 0.0256"
std::string label_of(const effects::EffectTerm& term, const physics::Units& units) {
  const FoundParameter strength = parameters_of(term, units).front();
  return term.effect + ", " + strength.name + formatted(" %.3g", strength.value) +
         (strength.unit.empty() ? "" : " " + strength.unit);
}

}  // namespace

effects::EffectTerm within_range(effects::EffectTerm term, const physics::Units& units) {
  const ParameterSpec& spec = effects::effects().find(term.effect).parameters.front();
  const double factor = effects::to_model_units(spec.unit, units);
  term.values.front() = std::clamp(term.values.front(), factor * spec.min, factor * spec.max);
  return term;
}

void take_over_ensembles(const fs::path& folder, const config::Configuration& model,
                         SeriesEnsemblesRequest& request) {
  const fs::path file = folder / kStrengths;
  const ensemble::EnsembleFolder base(folder / "base");
  if (!fs::exists(file) || !base.started())
    throw InputError(
        "--ensembles: " + folder.string() +
        " holds no simulations; the folder 'ensembles' of an earlier search is needed");
  request.runs = base.load().runs;
  request.looks = input::from_json(file, [&](const input::Json& json) {
    if (!json.contains("looks"))
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

std::string note_on_looks(const statistics::Window& simulated, const statistics::Window& measured) {
  constexpr double kFar = 3;
  if (measured.end < kFar * simulated.end && measured.end > simulated.end / kFar) return "";
  return formatted(
      "The strengths of the effects were chosen for observations from %.3g to %.3g s, but the "
      "measurements are from %.3g to %.3g s.",
      simulated.begin, simulated.end, measured.begin, measured.end);
}

void refuse_series(const observations::MeasuredVesicles& data, const config::Configuration& model) {
  input::refuse_scaled(model);
  run::refuse_discs(model);
  if (model.options().surface != "sphere")
    throw InputError(model.where(&config::RunOptions::surface) +
                     ": series can be explained on spheres only");
  if (!model.options().effect.empty())
    throw InputError(model.where(&config::RunOptions::effect) +
                     ": series need a model without effects; the search adds one effect at a time");
  ensemble::refuse_without_noise(model);
  selection::refuse_vesicles(data);
  if (const statistics::Window window = observations::looks(data); !(window.begin < window.end))
    throw InputError("series: observations at two or more times are needed");
}

SeriesEnsembles run_series_ensembles(const fs::path& folder, const config::Configuration& model,
                                     const SeriesEnsemblesRequest& request) {
  fs::create_directories(folder);
  const std::vector<effects::EffectTerm> terms = sizes(folder, model, request);
  posix::catch_stop_signals();
  const physics::Units units = model.units();
  SeriesEnsembles result;
  result.folder = fs::absolute(folder).lexically_normal();
  std::size_t ensembles = 0;
  const auto simulate = [&](const std::string& name, const std::string& effect,
                            const std::string& label) {
    tell(request,
         "simulations with " + label + formatted(" (%zu of %zu)", ++ensembles, terms.size() + 1));
    return ensemble::run_point(
        folder / name, ensemble_model(model, effect, kFastestDiffusionRatio * request.looks.end),
        {request.runs, request.jobs, request.quiet});
  };
  ensemble::PointEnd base = simulate("base", "", "no effect");
  if (!base.failures.empty())
    throw drivers::NumericalFailure("the run of seed " +
                                    std::to_string(base.failures.front().seed) +
                                    " failed: " + base.failures.front().why);
  result.base = std::move(base.runs);
  result.stopped = base.stopped;
  for (const effects::EffectTerm& sized : terms) {
    const effects::EffectTerm term = within_range(sized, units);
    if (result.stopped) return result;
    ensemble::PointEnd end =
        simulate(term.effect, effect_text({term}, units), label_of(term, units));
    result.stopped = end.stopped;
    if (!end.failures.empty()) {
      result.notes.push_back(term.effect + " is left out, because the run of seed " +
                             std::to_string(end.failures.front().seed) +
                             " failed: " + end.failures.front().why);
      continue;
    }
    result.candidates.push_back({term.effect, term.values.front(),
                                 assimilation::find_candidate(term.effect)->two_sided,
                                 std::move(end.runs)});
    result.terms.push_back(term);
  }
  return result;
}

}  // namespace traceraft::explain
