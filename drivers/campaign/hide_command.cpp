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
#include "verification/explain/blind/effect_size.hpp"
#include "verification/explain/forecast/candidates.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

struct HideCommand {
  GivenValues flags;
  std::string model, out, effects = "random";
  std::int64_t seed = -1;
  BlindRequest request;
  double blur_um = 0;
  double first_s = 0, last_s = 0;
  int truth_cells = 0;
  SharedNoise noise;
};

// "random" may be nothing.
std::vector<std::string> effects_of(const std::string& text, std::uint64_t seed) {
  if (text == "none") return {};
  if (text != "random") {
    std::vector<std::string> names = split_list(text);
    for (const std::string& name : names)
      if (name == "none" || name == "random" || std::count(names.begin(), names.end(), name) > 1)
        throw InputError("--effects: '" + name + "' stands beside others, or twice");
      else
        (void)candidate_to_hide(name);
    return names;
  }
  std::vector<std::string> all = effects_to_hide();
  const double u =
      uniform_random(seed, stream::hidden_effect, 0) * static_cast<double>(all.size() + 1);
  const auto index = static_cast<std::size_t>(u);
  return index < all.size() ? std::vector<std::string>{all[index]} : std::vector<std::string>{};
}

int hide_effects(const HideCommand& command) {
  GivenValues model = read_config_file(command.model, "--model");
  for (const auto& [name, value] : command.flags) model[name] = value;
  if (command.model.empty()) add_small_vesicle(model, "hide");
  const Configuration configuration(model, {});
  const Units units = configuration.units();
  BlindRequest request = command.request;
  request.cells = command.truth_cells > 0 ? command.truth_cells : truth_cells(model);
  request.seed = command.seed >= 0 ? static_cast<std::uint64_t>(command.seed) : random_seed();
  request.effects = effects_of(command.effects, request.seed);
  set_shared_noise(command.noise, request);
  request.blur = command.blur_um / units.length();
  if (!(request.blur < kWidestBlur))
    throw InputError("--blur: " + format_number(command.blur_um) + " um is not less than " +
                     format_number(kWidestBlur * units.length()) + ", a fifth of the radius");
  if (command.first_s > 0) request.first = command.first_s / units.time();
  if (command.last_s > 0) request.last = command.last_s / units.time();
  if (!(request.first < request.last))
    throw InputError("--first: " + format_number(request.first * units.time()) +
                     " s has to be before --last, " + format_number(request.last * units.time()) +
                     " s");
  const fs::path out = command.out.empty() ? first_free_folder("hidden") : command.out;
  if (fs::exists(out / "model.toml"))  // which is written last
    throw InputError("--out: " + out.string() + " holds a hidden truth already");
  refuse_foreign_folder(out, {"truth.json"});
  refuse_hiding(configuration, request);
  fs::create_directories(out);
  const FolderLock lock(out);
  end_on_stop_signals(kInterrupted, "nothing was hidden; give the same command again");
  say("computing the truth on %d cells\n", request.cells);
  if (2 * request.cells < 5 * configuration.options().cells)
    say("NOTE: the error of so coarse a truth may be named itself; 4 times --cells is safe\n");
  flush_output();
  hide(out, model, request);
  say("find it with: traceraft explain --data %s --model %s\n", in_shell((out / "data").string()),
      in_shell((out / "model.toml").string()));
  return kSuccess;
}

Action define_hide(CLI::App& app) {
  const auto command = std::make_shared<HideCommand>();
  BlindRequest& request = command->request;
  app.add_option("--model", command->model, "TOML file with the flags' names as keys")
      ->type_name("FILE");
  app.add_option("--out", command->out, "folder; default: runs/hidden-<number>")->type_name("DIR");
  app.add_option("--effects", command->effects,
                 "what is hidden: names with commas between them, none, or random")
      ->type_name("EFFECT,...")
      ->capture_default_str();
  app.add_option("--gap", request.gap,
                 "change of c that each makes from one snapshot to the next, over the standard "
                 "deviation of c")
      ->check(between(1e-3, 0.5))
      ->capture_default_str();
  app.add_option("--noise", request.noise, "of a value, over the standard deviation of c")
      ->check(between(1e-3, 2))
      ->capture_default_str();
  add_noise_options(app, command->noise);
  app.add_option("--stated", request.stated,
                 "write a column sigma, the noise, and in every second snapshot this times the "
                 "noise; 0: no "
                 "such column")
      ->check(between(0, 100))
      ->capture_default_str();
  app.add_option("--blur", command->blur_um,
                 "of the images, standard deviation of the point spread function in um")
      ->check(at_least(0))
      ->capture_default_str();
  app.add_option("--vesicles", request.vesicles, "how many, of one membrane and one radius")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--snapshots", request.snapshots, "of each vesicle")
      ->check(CLI::Range(2, 100))
      ->capture_default_str();
  app.add_option("--points", request.points, "of each snapshot")
      ->check(CLI::Range(100, 1000000))
      ->capture_default_str();
  app.add_option("--first", command->first_s, "time of the first snapshot in s; default: 20 R^2/D")
      ->check(positive());
  app.add_option("--last", command->last_s, "time of the last one in s; default: 90 R^2/D")
      ->check(positive());
  app.add_option("--pace", request.pace, "D of the truth over that of the model")
      ->check(between(0.1, 10))
      ->capture_default_str();
  app.add_option("--truth-cells", command->truth_cells,
                 "of the mesh that the truth is computed on; default: 4 times --cells")
      ->check(CLI::Range(8, 512));
  app.add_option("--seed", command->seed, "what chance does; default: nobody knows")
      ->check(between(0, kLargestSeed));
  add_vesicle_options(app, command->flags);
  app.footer(
      "The defaults are those of a vesicle that explain takes some minutes for; with --model they "
      "are its own.\nExample: traceraft hide --out riddle");
  return [command] { return hide_effects(*command); };
}

}  // namespace

Command hide_command() {
  return {"hide", "draw measurements with something hidden in them, for explain to find",
          Ranks::one, define_hide};
}

}  // namespace traceraft
