#include <CLI/CLI.hpp>
#include <algorithm>

#include "backends/posix/folder_lock.hpp"
#include "backends/posix/process.hpp"
#include "backends/sodium/seal.hpp"
#include "drivers/campaign/hidden_case.hpp"
#include "drivers/campaign/noise_flags.hpp"
#include "drivers/campaign/vesicle_flags.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/config/number_checks.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/input/field_dataset.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/random.hpp"
#include "verification/assimilation/forecast/candidates.hpp"
#include "verification/selection/blind/effect_size.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::campaign {
namespace {

namespace fs = std::filesystem;

struct HideCommand {
  config::GivenValues flags;
  std::string model, out, effects = "random";
  std::int64_t seed = -1;
  selection::BlindRequest request;
  double blur_um = 0;
  double first_s = 0, last_s = 0;
  int truth_cells = 0;
  SharedNoise noise;
};

// "random" may be nothing.
std::vector<std::string> effects_of(const std::string& text, std::uint64_t seed) {
  if (text == "none") return {};
  if (text != "random") {
    std::vector<std::string> names = config::split_list(text);
    for (const std::string& name : names)
      if (name == "none" || name == "random" || std::count(names.begin(), names.end(), name) > 1)
        throw InputError("--effects: '" + name +
                         "' cannot be combined with other names or given twice");
      else
        (void)selection::candidate_to_hide(name);
    return names;
  }
  std::vector<std::string> all = selection::effects_to_hide();
  const double u = uniform_random(seed, statistics::stream::hidden_effect, 0) *
                   static_cast<double>(all.size() + 1);
  const auto index = static_cast<std::size_t>(u);
  return index < all.size() ? std::vector<std::string>{all[index]} : std::vector<std::string>{};
}

int hide_effects(const HideCommand& command) {
  config::GivenValues model = config::read_config_file(command.model, "--model");
  for (const auto& [name, value] : command.flags) model[name] = value;
  if (command.model.empty()) add_small_vesicle(model, "hide");
  const config::Configuration configuration(model, {});
  const physics::Units units = configuration.units();
  selection::BlindRequest request = command.request;
  request.cells = command.truth_cells > 0 ? command.truth_cells : truth_cells(model);
  request.seed =
      command.seed >= 0 ? static_cast<std::uint64_t>(command.seed) : sodium::random_seed();
  request.effects = effects_of(command.effects, request.seed);
  set_shared_noise(command.noise, request);
  request.blur = command.blur_um / units.length();
  if (!(request.blur < input::kWidestBlur))
    throw InputError("--blur: " + format_number(command.blur_um) + " um is not less than " +
                     format_number(input::kWidestBlur * units.length()) +
                     ", a fifth of the radius");
  if (command.first_s > 0) request.first = command.first_s / units.time();
  if (command.last_s > 0) request.last = command.last_s / units.time();
  if (!(request.first < request.last))
    throw InputError("--first: " + format_number(request.first * units.time()) +
                     " s must be before --last, " + format_number(request.last * units.time()) +
                     " s");
  const fs::path out = command.out.empty() ? run::first_free_folder("hidden") : command.out;
  if (fs::exists(out / "model.toml"))  // which is written last
    throw InputError("--out: " + out.string() + " already holds a hidden truth");
  run::refuse_foreign_folder(out, {"truth.json"});
  refuse_hiding(configuration, request);
  fs::create_directories(out);
  const posix::FolderLock lock(out);
  posix::end_on_stop_signals(drivers::kInterrupted,
                             "nothing was written; give the same command again");
  text::say("computing the truth on %d cells\n", request.cells);
  if (2 * request.cells < 5 * configuration.options().cells)
    text::say(
        "NOTE: explain may take the error of this coarse mesh for an effect; 4 times --cells is "
        "safe\n");
  text::flush_output();
  hide(out, model, request);
  text::say("search for it with: traceraft explain --data %s --model %s\n",
            text::in_shell((out / "data").string()), text::in_shell((out / "model.toml").string()));
  return drivers::kSuccess;
}

drivers::Action define_hide(CLI::App& app) {
  const auto command = std::make_shared<HideCommand>();
  selection::BlindRequest& request = command->request;
  app.add_option("--model", command->model, "TOML file of the model, with names of flags as keys")
      ->type_name("FILE");
  app.add_option("--out", command->out, "new folder to write; default: runs/hidden-<number>")
      ->type_name("DIR");
  app.add_option("--effects", command->effects,
                 "effects to hide: comma-separated names, none, or random (one effect, or none)")
      ->type_name("EFFECT,...")
      ->capture_default_str();
  app.add_option("--gap", request.gap,
                 "size of each effect: the change of c that it causes between two snapshots, "
                 "divided by the standard deviation of c")
      ->check(config::between(1e-3, 0.5))
      ->capture_default_str();
  app.add_option("--noise", request.noise,
                 "noise of a value of c, divided by the standard deviation of c")
      ->check(config::between(1e-3, 2))
      ->capture_default_str();
  add_noise_options(app, command->noise);
  app.add_option("--stated", request.stated,
                 "write a column sigma with the noise, multiplied by this factor in every second "
                 "snapshot; 0: no column sigma")
      ->check(config::between(0, 100))
      ->capture_default_str();
  app.add_option("--blur", command->blur_um, "standard deviation of the point spread function (um)")
      ->check(config::at_least(0))
      ->capture_default_str();
  app.add_option("--vesicles", request.vesicles, "number of vesicles (same membrane and radius)")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--snapshots", request.snapshots, "number of snapshots of each vesicle")
      ->check(CLI::Range(2, 100))
      ->capture_default_str();
  app.add_option("--points", request.points, "number of points of each snapshot")
      ->check(CLI::Range(100, 1000000))
      ->capture_default_str();
  app.add_option("--first", command->first_s, "time of the first snapshot (s); default: 20 R^2/D")
      ->check(config::positive());
  app.add_option("--last", command->last_s, "time of the last snapshot (s); default: 90 R^2/D")
      ->check(config::positive());
  app.add_option("--diffusion-ratio", request.diffusion_ratio,
                 "D of the truth divided by D of the model")
      ->check(config::between(0.1, 10))
      ->capture_default_str();
  app.add_option("--pace", request.diffusion_ratio, "older name of --diffusion-ratio")
      ->check(config::between(0.1, 10))
      ->group("");
  app.add_option("--truth-cells", command->truth_cells,
                 "cells per edge of the mesh of the truth; default: 4 times --cells")
      ->check(CLI::Range(8, 512));
  app.add_option("--seed", command->seed, "seed of all random numbers; default: a random seed")
      ->check(config::between(0, config::kLargestSeed));
  add_vesicle_options(app, command->flags);
  app.footer(
      "The defaults describe a small vesicle, which explain searches in some minutes. With "
      "--model, the model's own\nsettings apply.\nExample: traceraft hide --out blind");
  return [command] { return hide_effects(*command); };
}

}  // namespace

drivers::Command hide_command() {
  return {"hide", "draw synthetic measurements with hidden effects, to test explain",
          drivers::Ranks::one, define_hide};
}

}  // namespace traceraft::campaign
