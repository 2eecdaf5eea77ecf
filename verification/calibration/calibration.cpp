#include "verification/calibration/calibration.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "verification/calibration/calibration_fit.hpp"

namespace traceraft::calibration {
namespace {

// How close to the end of what was looked at counts as its end, in ln: the range of R²/D is wide.
constexpr double kUnitEdge = 0.1, kSimulatedEdge = 1e-3;

Eigen::MatrixXd covariance(const std::vector<std::vector<double>>& replicates) {
  const auto rows = static_cast<Eigen::Index>(replicates.size());
  Eigen::MatrixXd values(rows, static_cast<Eigen::Index>(replicates.front().size()));
  for (Eigen::Index i = 0; i < rows; ++i)
    values.row(i) =
        Eigen::Map<const Vec>(replicates[static_cast<std::size_t>(i)].data(), values.cols());
  const Eigen::MatrixXd centred = values.rowwise() - values.colwise().mean();
  return centred.transpose() * centred / static_cast<double>(rows - 1);
}

std::vector<double> column(const std::vector<std::vector<double>>& replicates, std::size_t i) {
  std::vector<double> values;
  for (const auto& replicate : replicates) values.push_back(replicate[i]);
  return values;
}

statistics::Interval logarithms(const statistics::Interval& range) {
  return {std::log(range.low), std::log(range.high)};
}

// All in logarithms. `replicates`: estimates from data of the model found. By what they miss it,
// the estimate is corrected (the basic bootstrap: Davison and Hinkley 1997, section 5.2).
// `samples`: of vesicles or seeds. `probable`: what the interval cannot leave out. `searched`: of
// what ends within `edge` of its ends nothing is known.
CalibratedParameter parameter(const std::string& name, double found,
                              const std::vector<double>& replicates, int samples,
                              const statistics::Interval& probable,
                              const statistics::Interval& searched, double edge) {
  const auto corrected = [&](double share) {
    return 2 * found - statistics::quantile(replicates, share);
  };
  const double middle =
      std::clamp(corrected(0.5), std::min(found, searched.low), std::max(found, searched.high));
  const double centre = corrected(0.5), factor = statistics::factor_for_few(samples);
  const statistics::Interval wide{centre - factor * (centre - corrected(0.975)),
                                  centre + factor * (corrected(0.025) - centre)};
  const double low =
      std::max(std::min({wide.low, probable.low, middle}), std::min(middle, searched.low));
  const double high =
      std::min(std::max({wide.high, probable.high, middle}), std::max(middle, searched.high));
  const bool within = low > searched.low + edge && high < searched.high - edge;
  return {name,
          std::exp(middle),
          {std::exp(low), std::exp(high)},
          within,
          within && high - low < std::log(kDetermined)};
}

void set_best_powers(const Eigen::MatrixXd& spread, Calibration& result) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> directions(spread);
  Vec powers = directions.eigenvectors().col(0);
  powers[0] = -powers[0];  // of D, not of R²/D
  Eigen::Index largest = 0;
  powers.cwiseAbs().maxCoeff(&largest);
  result.best_deviation =
      std::sqrt(std::max(0.0, directions.eigenvalues()[0])) / std::fabs(powers[largest]);
  powers /= powers[largest];
  result.best_powers.assign(powers.data(), powers.data() + powers.size());
}

int count_at_bound(const std::vector<likelihood::EnsembleFit>& fits,
                   const statistics::Interval& allowed) {
  return static_cast<int>(
      std::count_if(fits.begin(), fits.end(), [&](const likelihood::EnsembleFit& fit) {
        return fit.seconds_per_unit() < 1.01 * allowed.low ||
               fit.seconds_per_unit() > 0.99 * allowed.high;
      }));
}

// Marks all parameters: the others go with the unit of time, and that was not found.
void mark_undetermined(Calibration& calibration) {
  for (CalibratedParameter& parameter : calibration.parameters) parameter.determined = false;
}

}  // namespace

std::vector<double> most_probable(const observations::MeasuredVesicles& data,
                                  const std::vector<SoughtParameter>& sought,
                                  const std::vector<CalibrationPoint>& points,
                                  const likelihood::UnitPrior& unit) {
  return CalibrationFit(data, sought, points, unit).found().ln_parameters;
}

Calibration calibrate(const observations::MeasuredVesicles& data,
                      const std::vector<SoughtParameter>& sought,
                      const std::vector<CalibrationPoint>& points,
                      const likelihood::UnitPrior& unit) {
  const CalibrationFit fit(data, sought, points, unit);
  const std::vector<std::vector<double>> replicates = fit.replicates();
  const Box simulated = explored(fit.points(), sought, 0);
  Calibration result;
  const std::vector<double> found = estimates(fit.found());
  result.parameters = {parameter("seconds_per_unit", found[0], column(replicates, 0), fit.samples(),
                                 logarithms(fit.units()), logarithms(unit.allowed), kUnitEdge)};
  for (std::size_t i = 0; i < sought.size(); ++i) {
    const statistics::Interval range{simulated.lower[i], simulated.upper[i]};
    const double deviation = fit.found().deviations[i];
    const statistics::Interval probable{found[i + 1] - deviation, found[i + 1] + deviation};
    result.parameters.push_back(parameter(sought[i].name, found[i + 1], column(replicates, i + 1),
                                          fit.samples(), probable, range,
                                          kSimulatedEdge * (range.high - range.low)));
  }
  const Eigen::MatrixXd spread = covariance(replicates);
  const Vec deviation = spread.diagonal().cwiseSqrt().cwiseMax(1e-12);
  result.correlation =
      deviation.cwiseInverse().asDiagonal() * spread * deviation.cwiseInverse().asDiagonal();
  result.correlation.diagonal().setOnes();  // also of what did not vary at all
  set_best_powers(spread, result);
  for (const JointFit& point : fit.at_points()) result.at_points.push_back(point.fit);
  result.best = fit.found().fit;
  result.at_bound = count_at_bound(result.at_points, unit.allowed);
  const double ln_unit = std::log(result.parameters[0].value);
  result.unit_at_bound = ln_unit < std::log(unit.allowed.low) + kUnitEdge ||
                         ln_unit > std::log(unit.allowed.high) - kUnitEdge;
  if (result.unit_at_bound) mark_undetermined(result);
  return result;
}

void mark_unconverged(Calibration& calibration) {
  calibration.converged = false;
  mark_undetermined(calibration);
}

std::vector<std::vector<double>> design_around(const std::vector<double>& centre, double step) {
  std::vector<std::vector<double>> points = {centre};
  for (std::size_t i = 0; i < centre.size(); ++i)
    for (const double sign : {-1.0, 1.0}) {
      points.push_back(centre);
      points.back()[i] += sign * step;
    }
  for (std::size_t i = 0; i < centre.size(); ++i)
    for (std::size_t j = i + 1; j < centre.size(); ++j) {
      points.push_back(centre);
      points.back()[i] += step;
      points.back()[j] += step;
    }
  return points;
}

}  // namespace traceraft::calibration
