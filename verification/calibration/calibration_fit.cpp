#include "verification/calibration/calibration_fit.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/error.hpp"
#include "kernel/core/random.hpp"
#include "verification/calibration/calibration_data.hpp"
#include "verification/calibration/local_regression.hpp"
#include "verification/likelihood/drawn_vesicles.hpp"
#include "verification/statistics/bootstrap.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::calibration {
namespace {

constexpr int kReplicates = 200;
constexpr double kOvershoot = 0.5;  // beyond what was explored, over its width
constexpr std::size_t kStarts = 3;  // best points, where searches begin

const std::vector<CalibrationPoint>& enough(const std::vector<CalibrationPoint>& points,
                                            const std::vector<SoughtParameter>& sought) {
  if (static_cast<int>(points.size()) < points_of_parabola(static_cast<int>(sought.size())))
    throw InputError("a calibration needs more points");
  return points;
}

statistics::Interval as_probable(const Evidence& evidence, const likelihood::RunCurves& runs,
                                 const likelihood::EnsembleFit& fit) {
  return likelihood::as_probable(evidence.observations, {&runs}, evidence.unit, fit);
}

// D alone, at each of the points.
std::vector<JointFit> fit_points(const Evidence& evidence,
                                 const std::vector<CalibrationPoint>& points,
                                 const RunEmulator& runs) {
  std::vector<JointFit> fits;
  for (std::size_t k = 0; k < points.size(); ++k)
    fits.push_back({points[k].ln_parameters, evidence.fit(runs.at_point(k)), {}});
  return fits;
}

// The points that the data do not exclude. As many as parabolas need are kept in any case, and two
// more for each parameter, so that parabolas go through the middle of them.
std::vector<CalibrationPoint> not_excluded(const std::vector<CalibrationPoint>& points,
                                           const std::vector<JointFit>& fits) {
  constexpr double kExcluded = 30;  // over the best deviance
  const int parameters = static_cast<int>(points.front().ln_parameters.size());
  const auto least = std::min(
      points.size(), static_cast<std::size_t>(points_of_parabola(parameters) + 2 * parameters));
  std::vector<double> deviances;
  for (const JointFit& fit : fits) deviances.push_back(fit.fit.deviance);
  std::sort(deviances.begin(), deviances.end());
  const double most = std::max(deviances.front() + kExcluded, deviances[least - 1]);
  std::vector<CalibrationPoint> kept;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (fits[k].fit.deviance <= most) kept.push_back(points[k]);
  return kept;
}

std::vector<JointFit> best_of(std::vector<JointFit> fits) {
  std::sort(fits.begin(), fits.end(),
            [](const JointFit& a, const JointFit& b) { return a.fit.deviance < b.fit.deviance; });
  fits.resize(std::min(fits.size(), kStarts));
  return fits;
}

std::size_t nearest(const std::vector<CalibrationPoint>& points, const std::vector<double>& at) {
  const auto distance = [&](const CalibrationPoint& point) {
    double squares = 0;
    for (std::size_t i = 0; i < at.size(); ++i)
      squares += (point.ln_parameters[i] - at[i]) * (point.ln_parameters[i] - at[i]);
    return squares;
  };
  return static_cast<std::size_t>(
      std::min_element(points.begin(), points.end(),
                       [&](const CalibrationPoint& a, const CalibrationPoint& b) {
                         return distance(a) < distance(b);
                       }) -
      points.begin());
}

// The raft fraction is an input of a simulation: measured fractions count where it is looked for.
std::vector<observations::Quantity> quantities_for(const std::vector<SoughtParameter>& sought) {
  std::vector<observations::Quantity> result{observations::Quantity::perimeter,
                                             observations::Quantity::rafts};
  if (std::any_of(sought.begin(), sought.end(),
                  [](const SoughtParameter& s) { return s.name == "fraction"; }))
    result.push_back(observations::Quantity::fraction);
  return result;
}

}  // namespace

Box explored(const std::vector<CalibrationPoint>& points,
             const std::vector<SoughtParameter>& sought, double overshoot) {
  Box box{points.front().ln_parameters, points.front().ln_parameters};
  for (const CalibrationPoint& point : points)
    for (std::size_t i = 0; i < box.lower.size(); ++i) {
      box.lower[i] = std::min(box.lower[i], point.ln_parameters[i]);
      box.upper[i] = std::max(box.upper[i], point.ln_parameters[i]);
    }
  for (std::size_t i = 0; i < box.lower.size(); ++i) {
    const double more = overshoot * (box.upper[i] - box.lower[i]);
    box.lower[i] = std::max(box.lower[i] - more, std::log(sought[i].allowed.low));
    box.upper[i] = std::min(box.upper[i] + more, std::log(sought[i].allowed.high));
  }
  return box;
}

std::vector<double> estimates(const JointFit& fit) {
  std::vector<double> ln{fit.fit.ln_unit};
  ln.insert(ln.end(), fit.ln_parameters.begin(), fit.ln_parameters.end());
  return ln;
}

CalibrationFit::CalibrationFit(const observations::MeasuredVesicles& data,
                               const std::vector<SoughtParameter>& sought,
                               const std::vector<CalibrationPoint>& points,
                               const likelihood::UnitPrior& unit)
    : data_(data),
      unit_(unit),
      vesicles_(telling_vesicles(data)),
      quantities_(quantities_for(sought)),
      count_(static_cast<int>(enough(points, sought).front().runs.size())),
      at_all_(fit_points(evidence(), points, RunEmulator(points))),
      points_(not_excluded(points, at_all_)),
      box_(explored(points_, sought, kOvershoot)),
      runs_(points_),
      at_points_(fit_points(evidence(), points_, runs_)),
      found_(fit_jointly(evidence(), runs_, box_, best_of(at_points_))) {}

// At each of the points.
std::vector<statistics::Interval> CalibrationFit::probable_units() const {
  const Evidence measured = evidence();
  std::vector<statistics::Interval> units;
  for (std::size_t k = 0; k < at_points_.size(); ++k)
    units.push_back(as_probable(measured, runs_.at_point(k), at_points_[k].fit));
  return units;
}

statistics::Interval CalibrationFit::units() const {
  return as_probable(evidence(), runs_.at(found_.ln_parameters), found_.fit);
}

// The point whose runs are the nearest to what was found, moved there, stand for the vesicles.
std::vector<std::vector<double>> CalibrationFit::replicates() const {
  const observations::StatedErrors errors(data_);
  const std::size_t near = nearest(points_, found_.ln_parameters);
  const likelihood::RunCurves there = runs_.at_point(near), here = runs_.at(found_.ln_parameters);
  const likelihood::ModelRuns model{&points_[near].runs, &there, &here};
  const std::vector<statistics::Interval> units = probable_units();
  const auto count = static_cast<std::size_t>(count_);
  std::vector<std::vector<double>> all;
  for (std::uint64_t r = 1; r <= kReplicates; ++r) {
    const observations::MeasuredVesicles vesicles =
        likelihood::drawn_vesicles(data_, errors, model, found_.fit, r);
    const likelihood::UnitPrior unit = likelihood::drawn_unit(found_.fit, unit_, r);
    const Evidence drawn{likelihood::observed_series(vesicles, vesicles_, quantities_), unit};
    const RunEmulator others = runs_.with_others(
        likelihood::weights_of_other_runs(count, r, statistics::replicate_stream::other_runs));
    // From another point each time, and another D: what is flat is not to be taken for known.
    const std::size_t k = r % at_points_.size();
    JointFit start = at_points_[k];
    start.fit.ln_unit = std::log(units[k].low) +
                        std::log(units[k].high / units[k].low) *
                            uniform_random(r, statistics::replicate_stream::search_start, 0);
    const JointFit fit = fit_jointly(drawn, others, box_, {start});
    // It may have stayed in a valley of its own, which is not as deep.
    const JointFit back = fit_jointly(drawn, others, box_, {found_});
    const bool as_deep = fit.fit.deviance < back.fit.deviance + likelihood::kAboutAsProbable;
    all.push_back(estimates(as_deep ? fit : back));
  }
  return all;
}

}  // namespace traceraft::calibration
