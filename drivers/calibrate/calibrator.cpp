#include "drivers/calibrate/calibrator.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/config/options.hpp"
#include "drivers/ensemble/run_cost.hpp"
#include "drivers/output/status_line.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::calibrate {
namespace {

// Steps in ln of the designs, each around what the one before finds: a smaller one follows where
// that lies within the design, the same size again where it does not.
constexpr double kSteps[] = {0.5, 0.25, 0.1};
constexpr int kMostRounds = 6;
constexpr double kRoundoff = 1e-9;

}  // namespace

int usual_most_cells(const config::Configuration& model) {
  constexpr int kUsual = 128;
  const double needed = std::exp(kSteps[0]) * static_cast<double>(model.options().cells);
  const double most = std::min(config::run_option("cells").max, 4 * std::ceil(needed / 4));
  return std::max(kUsual, static_cast<int>(most));
}

double end_of_runs(const observations::MeasuredVesicles& data) {
  return kFastest * observations::looks(data).end;
}

bool Calibrator::run() {
  if (!request_.quiet && !request_.names.empty())
    text::say(
        "%zu to %d rounds of simulations; each round has %zu choices of parameters; each choice "
        "has %d runs\n",
        std::size(kSteps), kMostRounds,
        calibration::design_around(std::vector<double>(request_.names.size()), 0).size(),
        request_.runs);
  std::vector<double> centre;
  for (const double value : values_of(model_, request_.names)) centre.push_back(std::log(value));
  const double seconds = model_.units().seconds_per_unit();
  const likelihood::UnitPrior unit =
      likelihood::UnitPrior::uniform(seconds, {seconds / kFastest, seconds * kSlowest});
  const double* step = std::begin(kSteps);
  for (int round = 0; round < kMostRounds && step != std::end(kSteps); ++round) {
    const std::vector<double> design = within_range(centre, *step);
    if (!add_points(calibration::design_around(design, *step), round + 1)) return false;
    if (centre.empty()) break;
    centre = calibration::most_probable(data_, sought(), points_, unit);
    double moved = 0;
    for (std::size_t i = 0; i < centre.size(); ++i)
      moved = std::max(moved, std::fabs(centre[i] - design[i]));
    if (moved <= (1 + kRoundoff) * *step) ++step;
  }
  result_ = calibration::calibrate(data_, sought(), points_, unit);
  if (!centre.empty() && step != std::end(kSteps)) calibration::mark_unconverged(result_);
  return true;
}

std::vector<calibration::SoughtParameter> Calibrator::sought() const {
  std::vector<calibration::SoughtParameter> all;
  for (const std::string& name : request_.names)
    all.push_back({name, range_of(model_, name, request_.most_cells)});
  return all;
}

// Moved so that all of the design can be run.
std::vector<double> Calibrator::within_range(std::vector<double> centre, double step) const {
  for (std::size_t i = 0; i < centre.size(); ++i) {
    const statistics::Interval range = range_of(model_, request_.names[i], request_.most_cells);
    const double low = std::log(range.low), high = std::log(range.high);
    centre[i] =
        high - low > 2 * step ? std::clamp(centre[i], low + step, high - step) : (low + high) / 2;
  }
  return centre;
}

bool Calibrator::add_points(const std::vector<std::vector<double>>& design, int round) {
  const std::string of = request_.names.empty() ? "" : formatted(" of round %d", round);
  for (std::size_t k = 0; k < design.size(); ++k)
    if (!add_point(design[k], formatted("%zu of %zu", k + 1, design.size()) + of)) return false;
  // Differences between points are known better if they are of the same seeds.
  ensemble::keep_common_seeds(ends_);
  if (ends_.front().runs.size() < 2)
    throw InputError("fewer than two seeds have finished for all choices of parameters");
  for (std::size_t k = 0; k < points_.size(); ++k) points_[k].runs = ends_[k].runs;
  return true;
}

// In proportion to the last one.
std::string Calibrator::expected_time(const config::Configuration& here) const {
  if (seconds_per_work_ == 0) return "";
  return ", about " + output::clock_text(seconds_per_work_ * ensemble::relative_work(here));
}

bool Calibrator::add_point(const std::vector<double>& ln, const std::string& number) {
  std::vector<double> values;
  std::string name = "point", words;
  for (std::size_t i = 0; i < ln.size(); ++i) {
    values.push_back(std::strtod(formatted("%.4g", std::exp(ln[i])).c_str(), nullptr));
    name += "-" + format_number(values.back());
    words += " " + request_.names[i] + " " + format_number(values.back());
  }
  const config::Configuration here =
      configuration_at(model_, request_.names, values, end_of_runs(data_));
  calibration::CalibrationPoint point;
  for (const double value : values_of(here, request_.names))
    point.ln_parameters.push_back(std::log(value));
  // Designs that end where meshes do may share points, which count once.
  for (const calibration::CalibrationPoint& before : points_)
    if (before.ln_parameters == point.ln_parameters) return true;
  if (!request_.quiet)
    text::say("simulations %s: at%s, %s cells%s\n", number, words.empty() ? " the model" : words,
              std::to_string(here.options().cells), expected_time(here));
  const std::filesystem::path folder = request_.out / "points" / name;
  const bool fresh = !std::filesystem::exists(folder);
  const Stopwatch watch;
  ensemble::PointEnd end = ensemble::run_point(
      folder, here, {request_.runs, request_.jobs, request_.quiet, request_.threads});
  if (end.stopped) return false;
  if (fresh) seconds_per_work_ = watch.seconds() / ensemble::relative_work(here);
  for (const ensemble::MemberFailure& failure : end.failures)
    text::say_error("the run of seed " + std::to_string(failure.seed) + " at" + words +
                    " failed: " + failure.why);
  ends_.push_back(std::move(end));
  points_.push_back(std::move(point));
  return true;
}

}  // namespace traceraft::calibrate
