#include "verification/vesicles/calibration.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "kernel/core/error.hpp"
#include "verification/measure/fit.hpp"
#include "verification/vesicles/joint_fit.hpp"
#include "verification/vesicles/local_regression.hpp"

namespace traceraft {
namespace {

constexpr int kReplicates = 200;
constexpr std::size_t kLeastVesicles = 3;  // to know how they scatter
constexpr double kOvershoot = 0.5;         // of what was explored, beyond it
constexpr double kDetermined = 2;          // factor between the ends of an interval
// How close to the end of what was looked at counts as its end, in ln: the range of R²/D is wide.
constexpr double kUnitEdge = 0.1, kSimulatedEdge = 1e-3;
// Of the points, where searches begin.
constexpr std::size_t kStarts = 3;

// Where there are points, and `overshoot` of that beyond, as far as it is allowed.
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

bool tells(const Measurement& m) {
  return m.of(Quantity::perimeter).value_or(0) > 0 || m.of(Quantity::rafts).value_or(0) > 0;
}

// Vesicles of which a perimeter or a number of rafts was measured.
std::vector<int> telling_vesicles(const MeasuredVesicles& data) {
  std::vector<int> result;
  const auto vesicles = data.vesicles();
  for (std::size_t k = 0; k < vesicles.size(); ++k) {
    const auto begin = data.measurements.begin();
    if (std::any_of(begin + static_cast<std::ptrdiff_t>(vesicles[k].first),
                    begin + static_cast<std::ptrdiff_t>(vesicles[k].second), tells))
      result.push_back(static_cast<int>(k));
  }
  return result;
}

std::vector<int> enough_vesicles(const MeasuredVesicles& data) {
  const std::vector<int> vesicles = telling_vesicles(data);
  if (vesicles.size() < kLeastVesicles)
    throw InputError(
        "a calibration needs three vesicles at least, to know how they scatter, with rafts whose "
        "perimeter or number was measured; there are " +
        std::to_string(vesicles.size()));
  return vesicles;
}

std::vector<int> some_of(const std::vector<int>& vesicles, std::uint64_t replicate) {
  std::vector<int> result;
  for (const int k : resample(static_cast<int>(vesicles.size()), replicate, 31))
    result.push_back(vesicles[k]);
  return result;
}

// D alone, at each of the points.
std::vector<JointFit> fit_points(const Evidence& evidence,
                                 const std::vector<CalibrationPoint>& points,
                                 const RunEmulator& runs) {
  std::vector<JointFit> fits;
  for (std::size_t k = 0; k < points.size(); ++k)
    fits.push_back({points[k].ln_parameters, evidence.fit(runs.at_point(k))});
  return fits;
}

std::vector<JointFit> best_of(std::vector<JointFit> fits) {
  std::sort(fits.begin(), fits.end(),
            [](const JointFit& a, const JointFit& b) { return a.time.deviance < b.time.deviance; });
  fits.resize(std::min(fits.size(), kStarts));
  return fits;
}

// Of ln R²/D and the parameters.
std::vector<double> estimates(const JointFit& fit) {
  std::vector<double> ln{std::log(fit.time.seconds_per_unit)};
  ln.insert(ln.end(), fit.ln_parameters.begin(), fit.ln_parameters.end());
  return ln;
}

ScatterLaws scatter_of(const std::vector<CalibrationPoint>& points) {
  std::vector<std::vector<History>> ensembles;
  for (const CalibrationPoint& point : points) ensembles.push_back(point.runs);
  return scatter_laws(ensembles);
}

class Fit {
 public:
  Fit(const MeasuredVesicles& data, const std::vector<SoughtParameter>& sought,
      const std::vector<CalibrationPoint>& points, const TimeUnit& unit)
      : data_(data), unit_(unit), vesicles_(enough_vesicles(data)), fractions_(data) {
    if (static_cast<int>(points.size()) < points_of_parabola(static_cast<int>(sought.size())))
      throw InputError("a calibration needs more points");
    box_ = explored(points, sought, kOvershoot);
    with_fractions_ = std::any_of(sought.begin(), sought.end(),
                                  [](const SoughtParameter& s) { return s.name == "fraction"; });
    count_ = static_cast<int>(points.front().runs.size());
    runs_.emplace(points, scatter_of(points));
    at_points_ = fit_points(evidence(vesicles_), points, *runs_);
    found_ = fit_jointly(evidence(vesicles_), *runs_, box_, best_of(at_points_));
  }

  const std::vector<JointFit>& at_points() const { return at_points_; }
  const JointFit& found() const { return found_; }

  // Of other vesicles and other runs of the same kind.
  std::vector<std::vector<double>> replicates() const {
    std::vector<std::vector<double>> all;
    for (std::uint64_t r = 1; r <= kReplicates; ++r) {
      const std::vector<int> some = some_of(vesicles_, r);
      const RunEmulator others = runs_->with_runs(resample(count_, r, 32));
      // From another point each time: what is flat is not to be taken for known.
      all.push_back(estimates(
          fit_jointly(evidence(some), others, box_, {at_points_[r % at_points_.size()]})));
    }
    return all;
  }

 private:
  Evidence evidence(const std::vector<int>& vesicles) const {
    return {data_, vesicles, with_fractions_ ? &fractions_ : nullptr, unit_};
  }

  const MeasuredVesicles& data_;
  const TimeUnit& unit_;
  std::vector<int> vesicles_;
  MeasuredFractions fractions_;
  bool with_fractions_ = false;
  int count_ = 0;
  Box box_;
  std::optional<RunEmulator> runs_;
  std::vector<JointFit> at_points_;
  JointFit found_;
};

Eigen::MatrixXd covariance(const std::vector<std::vector<double>>& replicates) {
  const auto rows = static_cast<Eigen::Index>(replicates.size());
  Eigen::MatrixXd values(rows, static_cast<Eigen::Index>(replicates.front().size()));
  for (Eigen::Index i = 0; i < rows; ++i)
    values.row(i) =
        Eigen::Map<const Vec>(replicates[static_cast<std::size_t>(i)].data(), values.cols());
  const Eigen::MatrixXd centred = values.rowwise() - values.colwise().mean();
  return centred.transpose() * centred / static_cast<double>(rows - 1);
}

// The median of the replicates is a better estimate than the fit to what was measured where that is
// flat, and takes its minimum from the noise of the runs (bagging: Breiman 1996).
CalibratedParameter parameter(const std::string& name, const std::vector<double>& replicates,
                              double lower, double upper, double edge) {
  const double low = quantile(replicates, 0.025), high = quantile(replicates, 0.975);
  return {name,
          std::exp(quantile(replicates, 0.5)),
          {std::exp(low), std::exp(high)},
          high - low < std::log(kDetermined) && low > lower + edge && high < upper - edge};
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

int count_at_bound(const std::vector<TimeFit>& fits, const Interval& allowed) {
  return static_cast<int>(std::count_if(fits.begin(), fits.end(), [&](const TimeFit& fit) {
    return fit.seconds_per_unit < 1.01 * allowed.low || fit.seconds_per_unit > 0.99 * allowed.high;
  }));
}

}  // namespace

void refuse_calibration(const MeasuredVesicles& data) {
  (void)enough_vesicles(data);
}

int looks_that_tell_nothing(const MeasuredVesicles& data) {
  return static_cast<int>(std::count_if(data.measurements.begin(), data.measurements.end(),
                                        [](const Measurement& m) { return !tells(m); }));
}

std::vector<double> most_probable(const MeasuredVesicles& data,
                                  const std::vector<SoughtParameter>& sought,
                                  const std::vector<CalibrationPoint>& points,
                                  const TimeUnit& unit) {
  return Fit(data, sought, points, unit).found().ln_parameters;
}

Calibration calibrate(const MeasuredVesicles& data, const std::vector<SoughtParameter>& sought,
                      const std::vector<CalibrationPoint>& points, const TimeUnit& unit) {
  const Fit fit(data, sought, points, unit);
  const std::vector<std::vector<double>> replicates = fit.replicates();
  const Box simulated = explored(points, sought, 0);
  Calibration result;
  for (std::size_t i = 0; i <= sought.size(); ++i) {
    std::vector<double> values;
    for (const auto& replicate : replicates) values.push_back(replicate[i]);
    result.parameters.push_back(parameter(
        i == 0 ? "seconds_per_unit" : sought[i - 1].name, values,
        i == 0 ? std::log(unit.allowed.low) : simulated.lower[i - 1],
        i == 0 ? std::log(unit.allowed.high) : simulated.upper[i - 1],
        i == 0 ? kUnitEdge : kSimulatedEdge * (simulated.upper[i - 1] - simulated.lower[i - 1])));
  }
  const Eigen::MatrixXd spread = covariance(replicates);
  const Vec deviation = spread.diagonal().cwiseSqrt().cwiseMax(1e-12);
  result.correlation =
      deviation.cwiseInverse().asDiagonal() * spread * deviation.cwiseInverse().asDiagonal();
  set_best_powers(spread, result);
  for (const JointFit& point : fit.at_points()) result.at_points.push_back(point.time);
  result.best = fit.found().time;
  result.at_bound = count_at_bound(result.at_points, unit.allowed);
  const double ln_unit = std::log(result.parameters[0].value);
  result.unit_at_bound = ln_unit < std::log(unit.allowed.low) + kUnitEdge ||
                         ln_unit > std::log(unit.allowed.high) - kUnitEdge;
  return result;
}

void mark_unconverged(Calibration& calibration) {
  calibration.converged = false;
  for (CalibratedParameter& parameter : calibration.parameters) parameter.determined = false;
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

}  // namespace traceraft
