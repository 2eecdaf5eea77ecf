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
#include "drivers/run/physical_model.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "kernel/effects/effects.hpp"
#include "verification/assimilation/forecast/candidates.hpp"
#include "verification/selection/blind/effect_size.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

// Of D over that of the model: runs last as long as if it were that.
constexpr double kFastestPace = 4;

void tell(const SeriesEnsemblesRequest& request, const std::string& step) {
  if (request.quiet) return;
  say("%s\n", step);
  flush_output();
}

Configuration ensemble_model(const Configuration& model, const std::string& effect, double t_end) {
  GivenValues given = settings_until(model, t_end);
  given["case"] = {model.options().case_name, "--case"};
  given["effect"] = {effect, "--effect"};
  return {{}, given};
}

BlindRequest sizing_request(const Configuration& model, const SeriesEnsemblesRequest& request) {
  const double time = model.units().time();
  BlindRequest sizing;
  sizing.base = physical_model(model);
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
EffectTerm sized_term(const EffectSizing& sizing, const std::string& effect, std::uint64_t number,
                      double mean) {
  const Candidate candidate = *find_candidate(effect);
  if (candidate.directions == 1) return sizing.term(effect, number);
  return sizing.term(effect, {candidate.step * (1 - mean), candidate.step * mean});
}

constexpr char kStrengths[] = "strengths.json";

// Which simulations they are for.
Json header_of(const Configuration& model, const Window& looks) {
  return {{"identity", numerical_identity(ensemble_model(model, "", looks.end))},
          {"looks", {looks.begin, looks.end}}};
}

bool is_for(const Json& json, const Json& header, const char* key) {
  return json.value(key, Json()) == header[key];
}

// What was found before; empty if that is nothing.
Json saved_strengths(const fs::path& file, const Json& header) {
  if (!fs::exists(file)) return Json::object();
  return from_json(file, [&](const Json& json) {
    if (!is_for(json, header, "identity") || !is_for(json, header, "looks"))
      throw InputError(file.parent_path().string() +
                       " holds simulations of another model, of an earlier version or for other "
                       "observation times; choose another --out or --ensembles");
    return json.at("strengths");
  });
}

// The parameters of an effect as a file has them, in units of R and R²/D.
EffectTerm saved_term(const fs::path& file, const std::string& effect, const Json& json,
                      const Units& units) {
  const std::vector<ParameterSpec>& specs = effects().find(effect).parameters;
  const std::string where = file.string() + ": strengths." + effect;
  if (!json.is_array() || json.size() != specs.size())
    throw DamagedFile(where + " is damaged: " + std::to_string(specs.size()) +
                      " numbers are needed");
  EffectTerm term{effect, {}};
  for (std::size_t k = 0; k < specs.size(); ++k) {
    const double factor = to_model_units(specs[k].unit, units);
    term.values.push_back(json[k].get<double>());
    // A strength that no range reaches is drawn back into it later.
    if (k > 0) check_value(where, term.values[k] / factor, WithinRange{specs[k].min, specs[k].max});
  }
  check_value(where, term.values.front(), WithinRange{-kAnyNumber, kAnyNumber});
  return term;
}

// The strengths of all effects, each found once.
std::vector<EffectTerm> sizes(const fs::path& folder, const Configuration& model,
                              const SeriesEnsemblesRequest& request) {
  const fs::path file = folder / kStrengths;
  Json saved = header_of(model, request.looks);
  Json& strengths = saved["strengths"] = saved_strengths(file, saved);
  const BlindRequest asked = sizing_request(model, request);
  std::optional<EffectSizing> sizing;
  std::vector<EffectTerm> terms;
  const std::vector<std::string> known = effects_to_hide();
  for (std::size_t k = 0; k < known.size(); ++k) {
    const std::string& effect = known[k];
    if (std::count(request.without.begin(), request.without.end(), effect) > 0 ||
        (effects().find(effect).unit_wells && !has_unit_wells(asked.base)))
      continue;
    if (!strengths.contains(effect)) {
      tell(request, "sizing the strength of " + effect);
      if (!sizing) sizing.emplace(asked);
      strengths[effect] = sized_term(*sizing, effect, k, asked.raft_fraction).values;
      write_durably(file, saved.dump(2) + "\n");
    }
    terms.push_back(saved_term(file, effect, strengths.at(effect), model.units()));
  }
  if (terms.empty()) throw InputError("--without: no effect is left to search for");
  return terms;
}

// "asymmetry, strength 0.0256"
std::string label_of(const EffectTerm& term, const Units& units) {
  const FoundParameter strength = parameters_of(term, units).front();
  return term.effect + ", " + strength.name + formatted(" %.3g", strength.value) +
         (strength.unit.empty() ? "" : " " + strength.unit);
}

}  // namespace

EffectTerm within_range(EffectTerm term, const Units& units) {
  const ParameterSpec& spec = effects().find(term.effect).parameters.front();
  const double factor = to_model_units(spec.unit, units);
  term.values.front() = std::clamp(term.values.front(), factor * spec.min, factor * spec.max);
  return term;
}

void take_over_ensembles(const fs::path& folder, const Configuration& model,
                         SeriesEnsemblesRequest& request) {
  const fs::path file = folder / kStrengths;
  const EnsembleFolder base(folder / "base");
  if (!fs::exists(file) || !base.started())
    throw InputError(
        "--ensembles: " + folder.string() +
        " holds no simulations; the folder 'ensembles' of an earlier search is needed");
  request.runs = base.load().runs;
  request.looks = from_json(file, [&](const Json& json) {
    if (!json.contains("looks"))
      throw InputError("--ensembles: " + folder.string() + " was written by an earlier version");
    const Window looks{json.at("looks").at(0), json.at("looks").at(1)};
    if (!(looks.begin > 0 && looks.begin < looks.end && looks.end <= kAnyNumber))
      throw InputError(file.string() + ": looks: two times are needed, the second after the first");
    if (!is_for(json, header_of(model, looks), "identity"))
      throw InputError("--ensembles: " + folder.string() +
                       " holds simulations of another model or of an earlier version");
    return looks;
  });
}

std::string note_on_looks(const Window& simulated, const Window& measured) {
  constexpr double kFar = 3;
  if (measured.end < kFar * simulated.end && measured.end > simulated.end / kFar) return "";
  return formatted(
      "The strengths of the effects were chosen for observations from %.3g to %.3g s, but the "
      "measurements are from %.3g to %.3g s.",
      simulated.begin, simulated.end, measured.begin, measured.end);
}

void refuse_series(const MeasuredVesicles& data, const Configuration& model) {
  refuse_scaled(model);
  if (model.options().surface != "sphere")
    throw InputError(model.where(&RunOptions::surface) +
                     ": series can be explained on spheres only");
  if (!model.options().effect.empty())
    throw InputError(model.where(&RunOptions::effect) +
                     ": series need a model without effects; the search adds one effect at a time");
  refuse_without_noise(model);
  refuse_vesicles(data);
  if (const Window window = looks(data); !(window.begin < window.end))
    throw InputError("series: observations at two or more times are needed");
}

SeriesEnsembles run_series_ensembles(const fs::path& folder, const Configuration& model,
                                     const SeriesEnsemblesRequest& request) {
  fs::create_directories(folder);
  const std::vector<EffectTerm> terms = sizes(folder, model, request);
  catch_stop_signals();
  const Units units = model.units();
  SeriesEnsembles result;
  result.folder = fs::absolute(folder).lexically_normal();
  std::size_t ensembles = 0;
  const auto simulate = [&](const std::string& name, const std::string& effect,
                            const std::string& label) {
    tell(request,
         "simulations with " + label + formatted(" (%zu of %zu)", ++ensembles, terms.size() + 1));
    return run_point(folder / name, ensemble_model(model, effect, kFastestPace * request.looks.end),
                     {request.runs, request.jobs, request.quiet});
  };
  PointEnd base = simulate("base", "", "no effect");
  if (!base.failures.empty())
    throw NumericalFailure("the run of seed " + std::to_string(base.failures.front().seed) +
                           " failed: " + base.failures.front().why);
  result.base = std::move(base.runs);
  result.stopped = base.stopped;
  for (const EffectTerm& sized : terms) {
    const EffectTerm term = within_range(sized, units);
    if (result.stopped) return result;
    PointEnd end = simulate(term.effect, effect_text({term}, units), label_of(term, units));
    result.stopped = end.stopped;
    if (!end.failures.empty()) {
      result.notes.push_back(term.effect + " is left out, because the run of seed " +
                             std::to_string(end.failures.front().seed) +
                             " failed: " + end.failures.front().why);
      continue;
    }
    result.candidates.push_back({term.effect, term.values.front(),
                                 find_candidate(term.effect)->two_sided, std::move(end.runs)});
    result.terms.push_back(term);
  }
  return result;
}

}  // namespace traceraft
