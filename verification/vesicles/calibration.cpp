#include "verification/vesicles/calibration.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "kernel/core/error.hpp"
#include "verification/measure/fit.hpp"
#include "verification/vesicles/response_surface.hpp"

namespace traceraft {
namespace {

constexpr int kReplicates = 200;
constexpr double kOvershoot = 0.5;  // of what was explored, beyond it
constexpr double kParabolic = 15;   // a deviance that much above the least counts half
constexpr double kDetermined = 2;   // factor between the ends of an interval
// How close to the end of what was looked at counts as its end, in ln: the range of R²/D is wide.
constexpr double kUnitEdge = 0.1, kSimulatedEdge = 1e-3;

// Mean raft fractions of vesicles, which scatter from vesicle to vesicle.
class MeasuredFractions {
 public:
  explicit MeasuredFractions(const MeasuredVesicles& data)
      : window_(looks(data)), means_(mean_fractions(data)) {
    std::vector<double> known;
    for (const auto& mean : means_)
      if (mean) known.push_back(*mean);
    if (known.size() > 1 && window_.end > 0) variance_ = std::pow(moments(known).deviation, 2);
  }

  // −2 ln of the likelihood of those of `sample`, if runs of that unit of time tell the truth.
  double deviance(const std::vector<int>& sample, const std::vector<History>& runs,
                  double seconds_per_unit) const {
    if (!(variance_ > 0)) return 0;
    const double t = std::sqrt(window_.begin * window_.end) / seconds_per_unit;
    double simulated = 0, sum = 0;
    for (const History& run : runs)
      simulated += run.at(Quantity::fraction, t) / static_cast<double>(runs.size());
    for (const int k : sample)
      if (means_[k]) sum += std::pow(*means_[k] - simulated, 2) / variance_;
    return sum;
  }

 private:
  Window window_;
  std::vector<std::optional<double>> means_;
  double variance_ = 0;  // 0: too few to say anything
};

// What one data set says: ln of R²/D and of the parameters.
struct Estimate {
  std::vector<double> ln;
  double scatter;
  std::vector<TimeFit> fits;
};

struct Box {
  std::vector<double> lower, upper;
};

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

// A deviance is a parabola near its minimum only.
std::vector<double> weights_of(const std::vector<double>& deviance) {
  const double least = *std::min_element(deviance.begin(), deviance.end());
  std::vector<double> weights;
  for (const double d : deviance)
    weights.push_back(1 / (1 + std::pow((d - least) / kParabolic, 2)));
  return weights;
}

Estimate estimate(const MeasuredVesicles& data, const std::vector<int>& vesicles,
                  const std::vector<CalibrationPoint>& points,
                  const std::vector<RunStatistics>& statistics, const Box& box,
                  const TimeUnit& unit, const MeasuredFractions* fractions,
                  const std::vector<TimeFit>* near = nullptr) {
  Estimate result;
  std::vector<std::vector<double>> x;
  std::vector<double> deviance, seconds, scatter;
  for (std::size_t k = 0; k < points.size(); ++k) {
    TimeFit fit = near ? fit_time(data, vesicles, statistics[k], unit, (*near)[k])
                       : fit_time(data, vesicles, statistics[k], unit);
    if (fractions)
      fit.deviance += fractions->deviance(vesicles, points[k].runs, fit.seconds_per_unit);
    result.fits.push_back(fit);
    x.push_back(points[k].ln_parameters);
    deviance.push_back(fit.deviance);
    seconds.push_back(std::log(fit.seconds_per_unit));
    scatter.push_back(std::log(fit.scatter));
  }
  if (box.lower.empty()) {  // nothing but the unit of time
    result.ln = {seconds.front()};
    result.scatter = std::exp(scatter.front());
    return result;
  }
  const std::vector<double> weights = weights_of(deviance);
  const auto surface = [&](const std::vector<double>& values) {
    return ResponseSurface(x, values, weights);
  };
  const std::vector<double> best = surface(deviance).minimiser(box.lower, box.upper);
  result.ln = {surface(seconds).at(best)};
  result.ln.insert(result.ln.end(), best.begin(), best.end());
  result.scatter = std::exp(surface(scatter).at(best));
  return result;
}

Eigen::MatrixXd covariance(const std::vector<std::vector<double>>& replicates) {
  const auto rows = static_cast<Eigen::Index>(replicates.size());
  Eigen::MatrixXd values(rows, static_cast<Eigen::Index>(replicates.front().size()));
  for (Eigen::Index i = 0; i < rows; ++i)
    values.row(i) =
        Eigen::Map<const Vec>(replicates[static_cast<std::size_t>(i)].data(), values.cols());
  const Eigen::MatrixXd centred = values.rowwise() - values.colwise().mean();
  return centred.transpose() * centred / static_cast<double>(rows - 1);
}

CalibratedParameter parameter(const std::string& name, double ln,
                              const std::vector<double>& replicates, double lower, double upper,
                              double edge) {
  const double low = quantile(replicates, 0.025), high = quantile(replicates, 0.975);
  return {name,
          std::exp(ln),
          {std::exp(low), std::exp(high)},
          high - low < std::log(kDetermined) && low > lower + edge && high < upper - edge};
}

int count_at_bound(const std::vector<TimeFit>& fits, const Interval& allowed) {
  return static_cast<int>(std::count_if(fits.begin(), fits.end(), [&](const TimeFit& fit) {
    return fit.seconds_per_unit < 1.01 * allowed.low || fit.seconds_per_unit > 0.99 * allowed.high;
  }));
}

}  // namespace

void refuse_calibration(const MeasuredVesicles& data) {
  if (data.vesicles().size() < 3)
    throw InputError("a calibration needs three vesicles at least, to know how they scatter");
  if (std::none_of(data.measurements.begin(), data.measurements.end(), [](const Measurement& m) {
        return m.of(Quantity::perimeter).value_or(0) > 0 || m.of(Quantity::rafts).value_or(0) > 0;
      }))
    throw InputError("a calibration needs perimeters or numbers of rafts");
}

Calibration calibrate(const MeasuredVesicles& data, const std::vector<SoughtParameter>& sought,
                      const std::vector<CalibrationPoint>& points, const TimeUnit& unit) {
  refuse_calibration(data);
  const int vesicles = static_cast<int>(data.vesicles().size());
  if (static_cast<int>(points.size()) < points_of_surface(static_cast<int>(sought.size())))
    throw InputError("a calibration needs more points");
  const Box box = explored(points, sought, kOvershoot), simulated = explored(points, sought, 0);
  std::vector<std::vector<History>> ensembles;
  for (const CalibrationPoint& point : points) ensembles.push_back(point.runs);
  const ScatterLaws scatter = scatter_laws(ensembles);
  std::vector<RunStatistics> statistics;
  for (const CalibrationPoint& point : points)
    statistics.emplace_back(point.runs, each_once(point.runs.size()), scatter);
  const MeasuredFractions measured(data);
  const bool sought_fraction = std::any_of(
      sought.begin(), sought.end(), [](const SoughtParameter& s) { return s.name == "fraction"; });
  const MeasuredFractions* fractions = sought_fraction ? &measured : nullptr;
  const Estimate found = estimate(data, each_once(static_cast<std::size_t>(vesicles)), points,
                                  statistics, box, unit, fractions);
  std::vector<std::vector<double>> replicates;
  for (std::uint64_t r = 1; r <= kReplicates; ++r) {
    std::vector<RunStatistics> others;
    // The same seeds at all points: what is common to them cancels in the comparison of points.
    for (const CalibrationPoint& point : points)
      others.emplace_back(point.runs, resample(static_cast<int>(point.runs.size()), r, 32),
                          scatter);
    replicates.push_back(
        estimate(data, resample(vesicles, r, 31), points, others, box, unit, fractions, &found.fits)
            .ln);
  }
  Calibration result;
  for (std::size_t i = 0; i <= sought.size(); ++i) {
    std::vector<double> values;
    for (const auto& replicate : replicates) values.push_back(replicate[i]);
    result.parameters.push_back(parameter(
        i == 0 ? "seconds_per_unit" : sought[i - 1].name, found.ln[i], values,
        i == 0 ? std::log(unit.allowed.low) : simulated.lower[i - 1],
        i == 0 ? std::log(unit.allowed.high) : simulated.upper[i - 1],
        i == 0 ? kUnitEdge : kSimulatedEdge * (simulated.upper[i - 1] - simulated.lower[i - 1])));
  }
  const Eigen::MatrixXd spread = covariance(replicates);
  const Vec deviation = spread.diagonal().cwiseSqrt().cwiseMax(1e-12);
  result.correlation =
      deviation.cwiseInverse().asDiagonal() * spread * deviation.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> directions(spread);
  Vec powers = directions.eigenvectors().col(0);
  powers[0] = -powers[0];  // of D, not of R²/D
  Eigen::Index largest = 0;
  powers.cwiseAbs().maxCoeff(&largest);
  result.best_deviation =
      std::sqrt(std::max(0.0, directions.eigenvalues()[0])) / std::fabs(powers[largest]);
  powers /= powers[largest];
  result.best_powers.assign(powers.data(), powers.data() + powers.size());
  result.at_points = found.fits;
  result.at_bound = count_at_bound(found.fits, unit.allowed);
  result.scatter = found.scatter;
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
