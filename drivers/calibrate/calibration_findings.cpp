#include "drivers/calibrate/calibration_findings.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/calibrate/calibration_points.hpp"
#include "kernel/core/text.hpp"
#include "verification/observations/differences.hpp"

namespace traceraft::calibrate {
namespace {

// Do the runs that fit best coarsen as the vesicles do?
bool are_alike(const std::vector<observations::Agreement>& agreements, std::size_t runs) {
  return std::none_of(agreements.begin(), agreements.end(), [&](const observations::Agreement& a) {
    return a.quantity != observations::Quantity::fraction &&
           (a.has_trend() || observations::lies_beside(a, runs));
  });
}

std::vector<CalibrationFinding> parameters_of(const observations::MeasuredVesicles& data,
                                              const config::Configuration& model, bool alike,
                                              const calibration::Calibration& result) {
  const double factor = observations::factor_of_size(data, model.units().length());
  std::vector<CalibrationFinding> found;
  for (const calibration::CalibratedParameter& p : result.parameters) {
    std::vector<std::string> open = why_undetermined(p, result);
    if (p.name == "seconds_per_unit") {
      if (!size_is_told(factor, p.interval)) open.push_back("the vesicles have another size");
      if (!alike) open.push_back("the runs do not coarsen as the vesicles do");
      found.push_back({"mobility", "cm^2/s", diffusion(model, p.value),
                       diffusion(model, p.interval.high), diffusion(model, p.interval.low), open});
    } else {
      found.push_back({p.name, p.name == "fraction" ? "1" : "um", p.value, p.interval.low,
                       p.interval.high, open});
    }
  }
  return found;
}

std::vector<observations::History> best_runs(const CalibrationRuns& all,
                                             const calibration::Calibration& result) {
  const auto& fits = result.at_points;
  const auto best =
      std::min_element(fits.begin(), fits.end(),
                       [](const likelihood::EnsembleFit& a, const likelihood::EnsembleFit& b) {
                         return a.deviance < b.deviance;
                       });
  return runs_in_seconds(all, result, static_cast<std::size_t>(best - fits.begin()));
}

// Did the search converge, and do all intervals end within what was looked at? What does not is
// known no better than that.
bool is_within(const calibration::Calibration& result) {
  return result.converged &&
         std::all_of(result.parameters.begin(), result.parameters.end(),
                     [](const calibration::CalibratedParameter& p) { return p.within; });
}

}  // namespace

double diffusion(const config::Configuration& model, double seconds_per_unit) {
  return model.units().with_seconds_per_unit(seconds_per_unit).diffusion_cm2_s;
}

std::vector<std::string> why_undetermined(const calibration::CalibratedParameter& p,
                                          const calibration::Calibration& result) {
  std::vector<std::string> why;
  if (p.determined) return why;
  const double span = p.interval.high / p.interval.low;
  if (!result.converged) why.push_back("the search did not converge");
  if (result.unit_at_bound) why.push_back("D lies at the end of the range searched");
  const bool is_unit = p.name == "seconds_per_unit";
  if (!p.within && !(is_unit && result.unit_at_bound))
    why.push_back(std::string("its interval reaches the end of ") +
                  (is_unit ? "the range searched" : "what was simulated"));
  if (span >= calibration::kDetermined || why.empty())
    why.push_back(formatted("its interval spans a factor of %.3g", span));
  return why;
}

bool size_is_told(double factor, const statistics::Interval& seconds_per_unit) {
  constexpr double kSame = 1.2;
  return std::fabs(std::log(factor)) <
         std::max(std::log(kSame), 0.5 * std::log(seconds_per_unit.high / seconds_per_unit.low));
}

std::vector<observations::History> runs_in_seconds(const CalibrationRuns& all,
                                                   const calibration::Calibration& result,
                                                   std::size_t choice) {
  std::vector<observations::History> runs = all.points[choice].runs;
  for (observations::History& run : runs)
    for (double& t : run.time) t *= result.at_points[choice].seconds_per_unit();
  return runs;
}

std::string best_known(const calibration::Calibration& result) {
  if (!is_within(result)) return "";
  std::string text;
  for (std::size_t i = 0; i < result.best_powers.size(); ++i) {
    const double power = result.best_powers[i];
    if (std::fabs(power) < 0.1) continue;  // hardly
    text += (text.empty() ? "" : " * ") +
            (i == 0 ? std::string("mobility") : result.parameters[i].name) +
            (std::fabs(power - 1) < 0.02 ? "" : formatted("^%.2f", power));
  }
  return text + formatted(" to %.0f %% (one standard error)", 100 * result.best_deviation);
}

config::Configuration found_model(const CalibrationRuns& runs,
                                  const std::vector<CalibrationFinding>& parameters) {
  std::vector<double> values;
  for (std::size_t i = 1; i < parameters.size(); ++i) values.push_back(parameters[i].value);
  const config::Configuration at =
      configuration_at(runs.model, runs.names, values, runs.model.options().t_end);
  config::GivenValues given;
  for (const config::OptionSpec& spec : config::run_options())
    if (!at.text(spec.name).empty() && spec.name != "output-times" && spec.name != "fields")
      given[spec.name] = {at.text(spec.name), "--" + spec.name};
  given["diffusion"] = {formatted("%.6g", parameters[0].value), "--diffusion"};
  return {{}, given};
}

input::Json calibration_json(const std::vector<CalibrationFinding>& parameters,
                             const calibration::Calibration& result) {
  input::Json json;
  for (const CalibrationFinding& found : parameters)
    json["parameters"][found.name] = {{"value", found.value},
                                      {"interval_95", {found.low, found.high}},
                                      {"unit", found.unit},
                                      {"determined", found.determined()},
                                      {"undetermined_because", found.open}};
  const std::string best = best_known(result);
  json["best_known"] = best.empty() ? input::Json() : input::Json(best);
  json["scatter_of_ln_perimeter"] =
      result.best.scatter_beyond_runs(observations::Quantity::perimeter);
  json["points_at_bound_of_mobility"] = result.at_bound;
  json["mobility_at_bound"] = result.unit_at_bound;
  json["converged"] = result.converged;
  for (Eigen::Index i = 0; i < result.correlation.rows(); ++i) {
    input::Json row = input::Json::array();
    // The correlations are those of ln D, not of ln R²/D.
    for (Eigen::Index j = 0; j < result.correlation.cols(); ++j)
      row.push_back(result.correlation(i, j) * ((i == 0) != (j == 0) ? -1 : 1));
    json["correlation"].push_back(row);
  }
  return json;
}

CalibrationFindings findings_of(const observations::MeasuredVesicles& data,
                                const CalibrationRuns& runs,
                                const calibration::Calibration& result) {
  CalibrationFindings found;
  found.best = best_runs(runs, result);
  found.agreements = observations::compare_with_runs(data, found.best);
  found.parameters =
      parameters_of(data, runs.model, are_alike(found.agreements, found.best.size()), result);
  return found;
}

}  // namespace traceraft::calibrate
