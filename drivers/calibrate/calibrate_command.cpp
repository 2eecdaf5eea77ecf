#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "backends/posix/durable_file.hpp"
#include "backends/posix/folder_lock.hpp"
#include "backends/posix/process.hpp"
#include "drivers/calibrate/calibration_points.hpp"
#include "drivers/calibrate/calibration_report.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/config/option_flags.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/input/dataset.hpp"
#include "drivers/input/measured_units.hpp"
#include "drivers/input/model_of_data.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/run/run_setup.hpp"
#include "drivers/vesicles/measured_report.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

// D is looked for up to this multiple of the model's, and runs go on as long; how small it may be
// costs nothing.
constexpr double kFastest = 4, kSlowest = 100;
// Steps in ln of the designs, each around what the one before finds: a smaller one follows where
// that lies within the design, the same size again where it does not.
constexpr double kSteps[] = {0.5, 0.25, 0.1};
constexpr int kMostRounds = 6;

struct CalibrateRequest {
  GivenValues flags;
  std::string data, model, ensemble, out, parameters;
  int runs = 8, jobs = 0;
  bool quiet = false;
};

std::vector<std::string> costly_parameters(const std::string& text) {
  std::vector<std::string> names;
  for (const std::string& name : split_list(text)) {
    (void)calibrated_options().find(name);
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw InputError("--parameters: " + name + " is there twice");
    names.push_back(name);
  }
  const auto mobility = std::find(names.begin(), names.end(), "mobility");
  if (mobility == names.end())
    throw InputError("--parameters: mobility has to be among them; it sets the unit of time");
  names.erase(mobility);
  return names;
}

// Up to the latest measurement if D were as large as it may be.
double end_of_runs(const MeasuredVesicles& data) {
  return kFastest * looks(data).end;
}

class Calibrator {
 public:
  Calibrator(const CalibrateRequest& request, const MeasuredVesicles& data,
             const Configuration& model, fs::path out)
      : request_(request),
        data_(data),
        model_(model),
        out_(std::move(out)),
        names_(costly_parameters(request.parameters)) {}

  // Rounds of simulations and a fit after each. False if it was stopped.
  bool run() {
    std::vector<double> centre;
    for (const double value : values_of(model_, names_)) centre.push_back(std::log(value));
    const double seconds = model_.units().seconds_per_unit();
    const TimeUnit unit{seconds, {seconds / kFastest, seconds * kSlowest}};
    const double* step = std::begin(kSteps);
    for (int round = 0; round < kMostRounds && step != std::end(kSteps); ++round) {
      const std::vector<double> design = within_range(centre, *step);
      if (!add_points(design_around(design, *step), round + 1)) return false;
      if (centre.empty()) break;
      centre = most_probable(data_, sought(), points_, unit);
      double moved = 0;
      for (std::size_t i = 0; i < centre.size(); ++i)
        moved = std::max(moved, std::fabs(centre[i] - design[i]));
      if (moved <= *step) ++step;
    }
    result_ = calibrate(data_, sought(), points_, unit);
    if (!centre.empty() && step != std::end(kSteps)) mark_unconverged(result_);
    return true;
  }

  const Calibration& result() const { return result_; }
  const std::vector<CalibrationPoint>& points() const { return points_; }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<SoughtParameter> sought() const {
    std::vector<SoughtParameter> all;
    for (const std::string& name : names_) all.push_back({name, range_of(model_, name)});
    return all;
  }
  // Moved so that all of the design can be run.
  std::vector<double> within_range(std::vector<double> centre, double step) const {
    for (std::size_t i = 0; i < centre.size(); ++i) {
      const Interval range = range_of(model_, names_[i]);
      const double low = std::log(range.low), high = std::log(range.high);
      centre[i] =
          high - low > 2 * step ? std::clamp(centre[i], low + step, high - step) : (low + high) / 2;
    }
    return centre;
  }
  bool add_points(const std::vector<std::vector<double>>& design, int round) {
    const double t_end = end_of_runs(data_);
    for (std::size_t k = 0; k < design.size(); ++k) {
      const std::vector<double>& ln = design[k];
      std::vector<double> values;
      std::string name = "point", words;
      for (std::size_t i = 0; i < ln.size(); ++i) {
        values.push_back(std::strtod(formatted("%.4g", std::exp(ln[i])).c_str(), nullptr));
        name += "-" + format_number(values.back());
        words += " " + names_[i] + " " + format_number(values.back());
      }
      if (!request_.quiet)
        std::printf("simulations %zu of %zu%s: at%s\n", k + 1, design.size(),
                    names_.empty() ? "" : formatted(" of round %d", round).c_str(),
                    words.empty() ? " the model" : words.c_str());
      const Configuration here = configuration_at(model_, names_, values, t_end);
      PointEnd end =
          run_point(out_ / "points" / name, here, {request_.runs, request_.jobs, request_.quiet});
      if (end.stopped) return false;
      for (const MemberFailure& failure : end.failures)
        std::fprintf(stderr, "traceraft: the run of seed %llu at%s failed: %s\n",
                     static_cast<unsigned long long>(failure.seed), words.c_str(),
                     failure.why.c_str());
      ends_.push_back(std::move(end));
      points_.emplace_back();
      for (const double value : values_of(here, names_))
        points_.back().ln_parameters.push_back(std::log(value));
    }
    // Differences between points are known better if they are of the same seeds.
    keep_common_seeds(ends_);
    if (ends_.front().runs.size() < 2)
      throw InputError("fewer than two seeds have finished at all points");
    for (std::size_t k = 0; k < points_.size(); ++k) points_[k].runs = ends_[k].runs;
    return true;
  }

  const CalibrateRequest& request_;
  const MeasuredVesicles& data_;
  const Configuration& model_;
  fs::path out_;
  std::vector<std::string> names_;
  std::vector<PointEnd> ends_;
  std::vector<CalibrationPoint> points_;  // of them
  Calibration result_;
};

// The folder of a calibration, which holds what decides the simulations.
constexpr char kIdentityFile[] = "calibration-model.toml";

fs::path folder_for(const CalibrateRequest& request) {
  const fs::path out = request.out.empty() ? first_free_folder("calibration") : request.out;
  refuse_foreign_folder(out, kIdentityFile);
  fs::create_directories(out);
  return out;
}

// One that goes on has to be the same.
void remember(const fs::path& out, const std::string& what, const Configuration& model) {
  const fs::path file = out / kIdentityFile;
  const std::string identity = "# " + what + "\n" + config_text(model);
  if (fs::exists(file) && read_file(file, 1 << 20) != identity)
    throw InputError(
        "--out: " + out.string() +
        " holds a calibration of another model, or of measurements until another time; "
        "choose another folder");
  write_durably(file, identity);
}

// D shifts the axis of time only if nothing else in the model has a unit of time, and seeds only
// differ if there is noise.
void refuse_calibrating(const Configuration& model) {
  const std::string effect = model.text("effect");
  for (const EffectEntry& entry : effects())
    for (const ParameterSpec& parameter : entry.parameters)
      if ((parameter.unit == "1/s" || parameter.unit == "s") &&
          effect.find(entry.name + ":") != std::string::npos)
        throw InputError(model.where("effect") + ": " + entry.name +
                         " has a time of its own, so that D is more than a unit of time; it cannot "
                         "be calibrated");
  refuse_without_noise(model);
  (void)build_run(model, InitialState::build);
}

// D alone, from runs that there are: it only shifts their time.
int calibrate_ensemble(const CalibrateRequest& request, const MeasuredVesicles& data) {
  if (request.parameters != "mobility")
    throw InputError("--parameters: runs of one model tell the mobility alone");
  for (const auto& [name, value] : request.flags)
    throw InputError(value.where + ": the model is that of --ensemble");
  if (!request.model.empty()) throw InputError("--model: the model is that of --ensemble");
  const Configuration model = model_of(request.ensemble);
  refuse_calibrating(model);
  const double seconds = model.units().seconds_per_unit();
  CalibrationPoint point{{}, runs_of(request.ensemble)};
  if (point.runs.size() < 2) throw InputError("--ensemble: fewer than two runs");
  double shortest = HUGE_VAL;
  for (History& run : point.runs) {
    shortest = std::min(shortest, run.time.back());
    for (double& t : run.time) t /= seconds;
  }
  const double fastest = shortest / looks(data).end;
  if (!(fastest > 1 / kSlowest))
    throw InputError("--ensemble: its runs end long before the measurements do");
  // Runs that end before the measurements do cover these for a smaller D only.
  const Interval covered{seconds / fastest, seconds * kSlowest};
  const Calibration result =
      calibrate(data, {}, {point}, {std::max(seconds, covered.low), covered});
  const fs::path out = folder_for(request);
  const FolderLock lock(out);
  remember(out, "mobility alone, from the runs in " + request.ensemble, model);
  const std::string bound = formatted(
      "D is looked for between %.3g and %.3g cm^2/s: of a larger one, runs that end at %.4g s know "
      "nothing at the times of the measurements; take an ensemble with a larger --t-end.",
      model.units().diffusion_cm2_s / kSlowest, model.units().diffusion_cm2_s * fastest, shortest);
  write_calibration(out, data, {model, {}, {point}, bound}, result, request.quiet);
  return kSuccess;
}

int run_calibration(CalibrateRequest request) {
  catch_stop_signals();
  if (request.data.empty()) throw InputError("--data: say which measurements to calibrate with");
  if (request.parameters.empty())
    request.parameters = request.ensemble.empty() ? "mobility,epsilon" : "mobility";
  (void)costly_parameters(request.parameters);
  const MeasuredVesicles data = read_dataset(request.data);
  refuse_calibration(data);
  if (!request.ensemble.empty()) return calibrate_ensemble(request, data);
  refuse_without_model(data, request.model, request.flags);
  const Configuration model(read_config_file(request.model, "--model"), request.flags);
  refuse_scaled(model);
  refuse_calibrating(model);
  const fs::path out = folder_for(request);
  const FolderLock lock(out);
  remember(out,
           "parameters " + request.parameters + ", " + std::to_string(request.runs) + " runs to " +
               format_number(end_of_runs(data)) + " s",
           model);
  Calibrator calibrator(request, data, model, out);
  if (!calibrator.run()) {
    if (!request.quiet) std::printf("to go on, give the same command with --out %s\n", out.c_str());
    return kInterrupted;
  }
  const double diffusion = model.units().diffusion_cm2_s;
  const std::string bound =
      formatted("D is looked for between %.3g and %.3g cm^2/s: begin with another --diffusion.",
                diffusion / kSlowest, diffusion * kFastest);
  write_calibration(out, data, {model, calibrator.names(), calibrator.points(), bound},
                    calibrator.result(), request.quiet);
  return kSuccess;
}

Action define_calibrate(CLI::App& app) {
  const auto request = std::make_shared<CalibrateRequest>();
  app.add_option("--data", request->data, "folder of the measurements (dataset.toml)");
  app.add_option("--model", request->model, "TOML file with the flags' names as keys");
  app.add_option("--ensemble", request->ensemble,
                 "find the mobility alone, from the runs of an ensemble or what is kept of them");
  app.add_option("--parameters", request->parameters,
                 "comma-separated, of mobility, epsilon, fraction, noise-length; default: "
                 "mobility,epsilon")
      ->check(
          [](const std::string& text) { return std::string(text.empty() ? "names none" : ""); });
  app.add_option("--runs", request->runs, "seeds that every choice of parameters is run with")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  app.add_option("--jobs", request->jobs, "runs at a time; default: one for each processor")
      ->check(CLI::Range(1, 1024));
  app.add_option("--out", request->out,
                 "folder, new or to go on with; default: runs/calibration-N");
  app.add_flag("--quiet", request->quiet, "print nothing but errors");
  add_options(app, request->flags, [](const OptionSpec& spec) {
    return spec.numerical && spec.name != "seed" && spec.name != "output-times";
  });
  app.footer(
      "Example: traceraft calibrate --data my-vesicles --case guv-3to1 --parameters "
      "mobility,epsilon");
  return [request] { return run_calibration(*request); };
}

}  // namespace

Command calibrate_command() {
  return {"calibrate", "find parameters of the model from measurements", Ranks::starts_them,
          define_calibrate};
}

}  // namespace traceraft
