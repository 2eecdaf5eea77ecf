#include "drivers/campaign/hidden_case.hpp"

#include <algorithm>
#include <cmath>

#include "backends/posix/own_files.hpp"
#include "backends/sodium/seal.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/input/field_dataset.hpp"
#include "drivers/input/json_file.hpp"
#include "drivers/input/measured_units.hpp"
#include "drivers/numerical_failure.hpp"
#include "drivers/run/physical_model.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft::campaign {
namespace {

namespace fs = std::filesystem;

// The truth is on a mesh this much finer than the model's, so that its own error is a sixteenth of
// that, and strengths are found on one in between.
constexpr double kFinerTruth = 4, kSizing = 1.75;

input::Json truth_json(const selection::BlindCase& drawn, const selection::BlindRequest& request,
                       const physics::Units& units) {
  physics::Units own = units;
  own.diffusion_cm2_s *= request.diffusion_ratio;
  input::Json hidden = input::Json::array();
  for (const effects::EffectTerm& term : drawn.truth) {
    const auto& specs = effects::effects().find(term.effect).parameters;
    input::Json values = input::Json::object();
    for (std::size_t k = 0; k < specs.size(); ++k)  // those that count
      if (effects::is_used(term, k))
        values[specs[k].name] = {
            {"value", term.values[k] / effects::to_model_units(specs[k].unit, own)},
            {"unit", specs[k].unit},
            {"scaled", term.values[k]}};
    hidden.push_back({{"effect", term.effect}, {"parameters", values}});
  }
  return {{"salt", sodium::random_salt()},
          {"seed", request.seed},
          {"effects", hidden},
          {"diffusion", own.diffusion_cm2_s},
          {"diffusion_ratio", request.diffusion_ratio},
          {"noise", drawn.noise},
          {"noise_share", request.noise_share},
          {"noise_correlation", request.noise_correlation},
          {"cells", request.cells},
          {"integrator", request.integrator},
          {"tolerance", request.tolerance}};
}

// Removes the snapshots of an attempt that was killed: it may have had more.
void forget_snapshots(const fs::path& data) {
  const std::vector<fs::directory_entry> files(fs::directory_iterator(data), {});
  for (const fs::path& file : files)
    if (input::is_snapshot_file(file)) fs::remove(file);
}

}  // namespace

void add_small_vesicle(config::GivenValues& model, const std::string& source) {
  for (const auto& [name, text] :
       {std::pair("epsilon", "0.6"), std::pair("cells", "24"), std::pair("raft-fraction", "0.5")})
    model.insert({name, {text, source}});
}

int truth_cells(const config::GivenValues& model) {
  const auto cells = static_cast<double>(config::Configuration(model, {}).options().cells);
  return static_cast<int>(std::lround(kFinerTruth * cells));
}

void refuse_hiding(const config::Configuration& model, const selection::BlindRequest& request) {
  input::refuse_scaled(model);
  if (model.options().surface != "sphere")
    throw InputError(model.where(&config::RunOptions::surface) +
                     ": measurements can be drawn on spheres only");
  if (!model.options().effect.empty())
    throw InputError(model.where(&config::RunOptions::effect) +
                     ": use --effects to hide an effect");
  if (request.cells <= model.options().cells)
    throw InputError("--truth-cells: " + std::to_string(request.cells) +
                     " must be more than the model's cells, " +
                     std::to_string(model.options().cells));
}

void hide(const fs::path& folder, const config::GivenValues& model,
          selection::BlindRequest request) {
  const config::Configuration configuration(model, {});
  refuse_hiding(configuration, request);
  const physics::Units units = configuration.units();
  request.base = run::physical_model(configuration);
  request.sizing_cells = std::min(
      request.cells,
      static_cast<int>(std::lround(kSizing * static_cast<double>(configuration.options().cells))));
  request.raft_fraction = configuration.options().raft_fraction;
  selection::BlindCase drawn =
      drivers::numerically([&] { return selection::draw_blind_case(request); });

  posix::make_inner_folder(folder / "data");
  const std::string truth = truth_json(drawn, request, units).dump(2) + "\n";
  posix::write_durably(folder / "truth.json", truth);
  posix::write_durably(folder / "data" / "seal.txt", sodium::sha256(truth) + "\n");
  for (assimilation::FieldSeries& vesicle : drawn.vesicles)
    for (assimilation::FieldSnapshot& snapshot : vesicle.snapshots) snapshot.time *= units.time();
  input::FieldDataset data;
  data.name = folder.filename().string();
  data.synthetic = true;
  data.origin = "drawn by traceraft hide; truth sealed by the hash in seal.txt";
  data.radius_um = units.length();
  data.blur_um = request.blur * units.length();
  data.vesicles = std::move(drawn.vesicles);
  forget_snapshots(folder / "data");
  input::write_field_dataset(folder / "data", data, "synthetic measurements");
  std::vector<std::string> names;
  for (const auto& [name, value] : model) names.push_back(name);
  posix::write_durably(folder / "model.toml", config::config_lines(configuration, names));
}

HiddenTruth open_truth(const fs::path& folder) {
  constexpr std::uint64_t kMaxBytes = 1 << 20;
  const std::string text = posix::read_file(folder / "truth.json", kMaxBytes);
  if (sodium::sha256(text) + "\n" != posix::read_file(folder / "data" / "seal.txt", kMaxBytes))
    throw IoError((folder / "truth.json").string() + " has changed since it was sealed");
  return input::from_json(folder / "truth.json", [](const input::Json& json) {
    HiddenTruth truth{{}, json.at("diffusion_ratio"), json.at("noise")};
    for (const input::Json& hidden : json.at("effects")) {
      effects::EffectTerm term{hidden.at("effect"), {}};
      const input::Json& values = hidden.at("parameters");
      for (const ParameterSpec& spec : effects::effects().find(term.effect).parameters)
        term.values.push_back(values.contains(spec.name)
                                  ? values.at(spec.name).at("scaled").get<double>()
                                  : spec.default_value);  // it does nothing
      truth.effects.push_back(term);
    }
    return truth;
  });
}

}  // namespace traceraft::campaign
