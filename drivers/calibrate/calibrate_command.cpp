#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <optional>

#include "backends/posix/durable_file.hpp"
#include "backends/posix/folder_lock.hpp"
#include "backends/posix/process.hpp"
#include "drivers/calibrate/calibration_report.hpp"
#include "drivers/calibrate/calibrator.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/config/number_checks.hpp"
#include "drivers/config/option_flags.hpp"
#include "drivers/config/options.hpp"
#include "drivers/data/measured_report.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/input/dataset.hpp"
#include "drivers/input/measured_units.hpp"
#include "drivers/input/model_of_data.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/run/run_setup.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "kernel/effects/effects.hpp"
#include "verification/calibration/calibration_data.hpp"

namespace traceraft::calibrate {
namespace {

namespace fs = std::filesystem;

struct CalibrateRequest {
  config::GivenValues flags;
  std::string data, model, ensemble, out, parameters;
  int runs = 8, jobs = 0, threads = 0, most_cells = 0;  // 0: by processors; see most_cells_of
  bool quiet = false;
};

std::vector<std::string> costly_parameters(const std::string& text) {
  std::vector<std::string> names;
  for (const std::string& name : config::split_list(text)) {
    (void)calibrated_options().find(name);
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw InputError("--parameters: " + name + " is given twice");
    names.push_back(name);
  }
  const auto mobility = std::find(names.begin(), names.end(), "mobility");
  if (mobility == names.end())
    throw InputError("--parameters: mobility must be one of them, as it sets the unit of time");
  names.erase(mobility);
  return names;
}

// The folder of a calibration, which holds what decides the simulations, and where the data are.
constexpr char kIdentityFile[] = "calibration-model.toml";

fs::path folder_for(const CalibrateRequest& request) {
  const fs::path out = request.out.empty() ? run::first_free_folder("calibration") : request.out;
  run::refuse_foreign_folder(out, {kIdentityFile});
  fs::create_directories(out);
  return out;
}

// One that goes on has to be the same.
void remember(const fs::path& out, const std::string& what, const std::string& data,
              const config::Configuration& model) {
  const fs::path file = out / kIdentityFile;
  const std::string heading = "# " + what + "\n# of the measurements in " +
                              text::in_comment(fs::absolute(data).lexically_normal().string()) +
                              "\n";
  const auto is_same = [&] {
    return posix::read_file(file, 1 << 20).compare(0, heading.size(), heading) == 0 &&
           config::numerical_identity({config::read_config_file(file), {}}) ==
               config::numerical_identity(model);
  };
  if (fs::exists(file) && !is_same())
    throw InputError(
        "--out: " + out.string() +
        " holds a calibration of another model or with other measurements; choose another folder");
  posix::write_durably(file, heading + config::config_text(model));
}

// D shifts the axis of time only if nothing else in the model has a unit of time.
void refuse_calibrating(const config::Configuration& model) {
  const std::string effect = model.options().effect;
  for (const effects::EffectEntry& entry : effects::effects())
    for (const ParameterSpec& parameter : entry.parameters)
      if ((effects::is_rate(parameter.unit) || parameter.unit == "s") &&
          effect.find(entry.name + ":") != std::string::npos)
        throw InputError(model.where(&config::RunOptions::effect) + ": " + entry.name +
                         " has its own unit of time; D cannot be calibrated with it");
}

void refuse_other_membrane(const std::string& flag, const observations::MeasuredVesicles& data,
                           const config::Configuration& model) {
  if (const std::string other = input::other_membrane(data.composition, model); !other.empty())
    throw InputError(flag + ": the simulated membrane is " + other +
                     "; each membrane has its own D");
}

// D alone, from runs that there are: it only shifts their time.
int calibrate_ensemble(const CalibrateRequest& request,
                       const observations::MeasuredVesicles& data) {
  if (request.parameters != "mobility")
    throw InputError("--parameters: with --ensemble only mobility can be found");
  for (const auto& [name, value] : request.flags)
    throw InputError(value.where + ": not allowed with --ensemble, which has its own model");
  if (!request.model.empty())
    throw InputError("--model: not allowed with --ensemble, which has its own model");
  const config::Configuration model = data::model_of(request.ensemble);
  refuse_other_membrane("--ensemble", data, model);
  refuse_calibrating(model);
  const double seconds = model.units().seconds_per_unit();
  data::EnsembleRuns ensemble = data::runs_of(request.ensemble);
  calibration::CalibrationPoint point{{}, std::move(ensemble.histories)};
  if (point.runs.size() < 2) throw InputError("--ensemble: at least two finished runs are needed");
  double shortest = HUGE_VAL;
  for (observations::History& run : point.runs) {
    shortest = std::min(shortest, run.time.back());
    for (double& t : run.time) t /= seconds;
  }
  const double fastest = shortest / observations::looks(data).end;
  if (!(fastest > 1 / kSlowest))
    throw InputError("--ensemble: its runs end long before the measurements");
  // Runs that end before the measurements do cover these for a smaller D only.
  const statistics::Interval covered{seconds / fastest, seconds * kSlowest};
  posix::end_on_stop_signals(drivers::kInterrupted, "repeat the command");
  const calibration::Calibration result = calibration::calibrate(
      data, {}, {point}, likelihood::UnitPrior::uniform(std::max(seconds, covered.low), covered));
  const fs::path out = folder_for(request);
  const posix::FolderLock lock(out);
  remember(out, "mobility alone, from the runs in " + request.ensemble, request.data, model);
  const std::string bound = formatted(
      "The range searched for D is %.3g to %.3g cm^2/s. For a larger D, the runs, which end at "
      "%.4g s, would not reach the times of the measurements. Use an ensemble with a larger "
      "--t-end.",
      model.units().diffusion_cm2_s / kSlowest, model.units().diffusion_cm2_s * fastest, shortest);
  const std::string command = "traceraft calibrate --data " + text::in_shell(request.data) +
                              " --ensemble " + text::in_shell(request.ensemble) +
                              " --parameters mobility";
  write_calibration(out, data, {model, {}, {point}, 0, command, bound, ensemble.missing}, result,
                    request.quiet);
  return drivers::kSuccess;
}

// Fewer cells than the model's would make its own ε too small.
int most_cells_of(const CalibrateRequest& request, const config::Configuration& model) {
  const auto own = static_cast<int>(model.options().cells);
  if (request.most_cells == 0) return usual_most_cells(model);
  if (request.most_cells >= own) return std::max((own + 3) / 4, request.most_cells / 4) * 4;
  throw InputError("--most-cells: " + std::to_string(request.most_cells) +
                   " is less than the model's --cells, " + std::to_string(own));
}

int run_calibration(CalibrateRequest request) {
  posix::catch_stop_signals();
  if (request.data.empty()) throw InputError("--data: a folder of measurements is needed");
  if (request.parameters.empty())
    request.parameters = request.ensemble.empty() ? "mobility,epsilon" : "mobility";
  const std::vector<std::string> costly = costly_parameters(request.parameters);
  const observations::MeasuredVesicles data = input::read_dataset(request.data);
  (void)calibration::telling_vesicles(data);  // or refuses them
  if (!request.ensemble.empty()) return calibrate_ensemble(request, data);
  input::refuse_without_model(data.composition, request.model, request.flags);
  config::GivenValues file = config::read_model(request.model);
  file.merge(config::uniform_mesh());
  const config::Configuration model(file, request.flags);
  if (std::find(costly.begin(), costly.end(), "fraction") == costly.end())
    refuse_other_membrane(model.where(&config::RunOptions::case_name), data, model);
  input::refuse_scaled(model);
  refuse_calibrating(model);
  ensemble::refuse_without_noise(model);
  (void)run::build_run(model);
  const int most_cells = most_cells_of(request, model);
  const fs::path out = folder_for(request);
  const posix::FolderLock lock(out);
  remember(out,
           "parameters " + request.parameters + ", " + std::to_string(request.runs) + " runs to " +
               format_number(end_of_runs(data)) + " s, at most " + std::to_string(most_cells) +
               " cells",
           request.data, model);
  const CalibratorRequest simulations{out,          costly,          most_cells,   request.runs,
                                      request.jobs, request.threads, request.quiet};
  Calibrator calibrator(simulations, data, model);
  if (!calibrator.run()) {
    if (!request.quiet)
      text::say("to continue, give the same command with --out %s\n", text::in_shell(out.string()));
    return drivers::kInterrupted;
  }
  posix::end_on_stop_signals(
      drivers::kInterrupted,
      "all runs are finished; to continue, give the same command with --out " +
          text::in_shell(out.string()));
  const double diffusion = model.units().diffusion_cm2_s;
  const std::string bound =
      formatted("The range searched for D is %.3g to %.3g cm^2/s. Start from another --diffusion.",
                diffusion / kSlowest, diffusion * kFastest);
  const std::string command =
      "traceraft calibrate --data " + text::in_shell(request.data) + " --model " +
      text::in_shell((out / kIdentityFile).string()) + " --parameters " + request.parameters +
      " --runs " + std::to_string(request.runs) + " --most-cells " + std::to_string(most_cells);
  write_calibration(out, data,
                    {model, simulations.names, calibrator.points(), most_cells, command, bound},
                    calibrator.result(), request.quiet);
  return drivers::kSuccess;
}

drivers::Action define_calibrate(CLI::App& app) {
  const auto request = std::make_shared<CalibrateRequest>();
  app.add_option("--data", request->data, "folder of the measurements (dataset.toml)")
      ->type_name("DIR");
  app.add_option("--model", request->model,
                 "TOML file of the model, with names of flags as keys; or discs, with the flags")
      ->type_name("FILE");
  CLI::Option* const ensemble = app.add_option("--ensemble", request->ensemble,
                                               "folder of an ensemble, or of its kept histories: "
                                               "find the mobility only, without new simulations")
                                    ->type_name("DIR");
  app.add_option("--parameters", request->parameters,
                 "parameters to find, comma-separated: mobility and any of epsilon, fraction, "
                 "noise-length; default: mobility,epsilon, or mobility with --ensemble")
      ->type_name(joined(calibrated_options().names(), "|") + ",...")
      ->check([](const std::string& text) {
        return std::string(text.empty() ? "no parameter is named" : "");
      });
  app.add_option("--runs", request->runs, "number of seeds for every choice of parameters")
      ->check(CLI::Range(2, 1000))
      ->excludes(ensemble)
      ->capture_default_str();
  app.add_option("--most-cells", request->most_cells,
                 "largest number of cells per edge; a smaller epsilon needs more cells, so that "
                 "this bounds it from below; default: 1.65 times --cells, at least 128")
      ->excludes(ensemble)
      ->check(config::between(4, config::run_option("cells").max));
  app.add_option("--jobs", request->jobs, "runs at a time; default: one for each processor")
      ->excludes(ensemble)
      ->check(CLI::Range(1, 1024));
  app.add_option("--threads", request->threads, "threads of each run; default: processors / --jobs")
      ->excludes(ensemble)
      ->check(CLI::Range(1, 64));
  app.add_option("--out", request->out,
                 "new folder, or folder of a calibration to continue; default: runs/calibration-N")
      ->type_name("DIR");
  app.add_flag("--quiet", request->quiet, "print errors only");
  const auto wanted = [](const config::OptionSpec& spec) {
    return spec.numerical && spec.name != "seed" && spec.name != "output-times" &&
           spec.name != "model";
  };
  config::add_options(app, request->flags, wanted, config::uniform_mesh());
  app.footer(
      "Example: traceraft calibrate --data my-vesicles --case guv-3to1 --parameters "
      "mobility,epsilon");
  return [request] { return run_calibration(*request); };
}

}  // namespace

drivers::Command calibrate_command() {
  return {"calibrate", "find parameters of the model from measurements",
          drivers::Ranks::starts_them, define_calibrate};
}

}  // namespace traceraft::calibrate
