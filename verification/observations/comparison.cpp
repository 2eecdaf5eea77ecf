#include "verification/observations/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "kernel/core/error.hpp"
#include "verification/observations/stated_errors.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::observations {
namespace {

bool relative(Quantity quantity) {
  return quantity != Quantity::fraction;
}

struct Deviation {
  std::string vesicle;
  double ln_time;
  double off, size;  // measured − mean of the runs, and its standard deviation
  double share;      // the latter over what is measured
  bool within;       // the range of the runs

  double z() const { return off / std::max(size, 1e-6); }
};

// The deviation of one measurement, of logarithms where scatter is relative.
Deviation deviation_of(const Measurement& m, Quantity quantity,
                       const std::vector<const History*>& runs, const StatedErrors& errors) {
  const double y = *m.of(quantity);
  std::vector<double> values;
  for (const History* run : runs) values.push_back(run->at(quantity, m.time));
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const bool within = y >= *low && y <= *high;
  if (relative(quantity))
    for (double& value : values) value = logarithm_of(quantity, value);
  const statistics::Sample runs_here = statistics::sample_of(values);
  const double ln_expected =
      relative(quantity) ? runs_here.mean : logarithm_of(quantity, runs_here.mean);
  const StatedError error = errors.of(m, quantity);
  const double sigma =
      std::sqrt(error.of_logarithm(ln_expected)) * (relative(quantity) ? 1 : std::exp(ln_expected));
  const double measured = relative(quantity) ? std::log(y) - error.bias(ln_expected) : y;
  const double of_mean = 1 + 1 / static_cast<double>(runs.size());
  const double deviation = std::hypot(runs_here.deviation * std::sqrt(of_mean), sigma);
  const double unit = relative(quantity) ? 1 : std::max(runs_here.mean, 1e-6);
  return {m.vesicle, std::log(m.time), measured - runs_here.mean,
          deviation, deviation / unit, within};
}

std::vector<const History*> pointers(const std::vector<History>& runs) {
  std::vector<const History*> result;
  for (const History& run : runs) result.push_back(&run);
  return result;
}

// The least squares slope of z over ln t; the error of what vesicles leave, looks at one of which
// are alike (clusters: Liang and Zeger 1986).
struct Slope {
  double value = 0, error = 0;
};
Slope slope_of(const std::vector<Deviation>& all) {
  double time = 0, z = 0, xx = 0, xz = 0;
  for (const Deviation& d : all) {
    time += d.ln_time / static_cast<double>(all.size());
    z += d.z() / static_cast<double>(all.size());
  }
  for (const Deviation& d : all) {
    xx += (d.ln_time - time) * (d.ln_time - time);
    xz += (d.ln_time - time) * d.z();
  }
  if (!(xx > 0)) return {};
  const double slope = xz / xx;
  std::map<std::string, double> scores;
  for (const Deviation& d : all)
    scores[d.vesicle] += (d.ln_time - time) * (d.z() - z - slope * (d.ln_time - time));
  double squares = 0;
  for (const auto& [vesicle, score] : scores) squares += score * score;
  const auto n = static_cast<double>(scores.size());
  return {slope, n > 1 ? std::sqrt(squares * n / (n - 1)) / xx : 0};
}

class Comparison {
 public:
  Comparison(const MeasuredVesicles& data, const std::vector<History>& runs, Quantity quantity)
      : runs_(pointers(runs)), errors_(data) {
    result_.quantity = quantity;
    constexpr double kRoundoff = 1e-9;  // of times
    double first = 0, last = HUGE_VAL;
    for (const History& run : runs) {
      first = std::max(first, run.time.front());
      last = std::min(last, run.time.back());
    }
    for (const Measurement& m : data.measurements) {
      if (!m.of(quantity)) continue;
      if (!(m.time > 0) || m.time < first || m.time > (1 + kRoundoff) * last)
        ++result_.beyond;
      else if (relative(quantity) && !(*m.of(quantity) > 0))
        ++result_.without_rafts;
      else
        compared_.push_back(&m);
    }
  }

  Agreement run() {
    const std::vector<Deviation> all = deviations(runs_);
    for (const Deviation& d : all) {
      result_.within += d.within;
      result_.scatter += d.share * d.share;
      result_.bias += d.z();
      result_.misfit += d.z() * d.z();
    }
    result_.measurements = static_cast<int>(all.size());
    const double count = std::max(1, result_.measurements);
    result_.bias /= count;
    result_.misfit = std::sqrt(result_.misfit / count);
    result_.scatter = std::sqrt(result_.scatter / count);
    set_trend(all);
    return result_;
  }

 private:
  std::vector<Deviation> deviations(const std::vector<const History*>& runs) const {
    std::vector<Deviation> all;
    for (const Measurement* m : compared_)
      all.push_back(deviation_of(*m, result_.quantity, runs, errors_));
    return all;
  }

  // The error of the runs' means by leaving out each of them (jackknife).
  void set_trend(const std::vector<Deviation>& all) {
    constexpr std::size_t kFewestRuns = 6, kFewestVesicles = 8;
    std::set<std::string> vesicles;
    for (const Deviation& d : all) vesicles.insert(d.vesicle);
    if (runs_.size() < kFewestRuns || vesicles.size() < kFewestVesicles) return;
    const Slope slope = slope_of(all);
    std::vector<double> without;
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      std::vector<const History*> others = runs_;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      std::vector<Deviation> changed = deviations(others);
      for (std::size_t i = 0; i < all.size(); ++i) changed[i].size = all[i].size;
      without.push_back(slope_of(changed).value);
    }
    const auto n = static_cast<double>(runs_.size());
    result_.trend = slope.value;
    result_.trend_error =
        std::hypot(slope.error, statistics::sample_of(without).deviation * (n - 1) / std::sqrt(n));
  }

  const std::vector<const History*> runs_;
  const StatedErrors errors_;
  std::vector<const Measurement*> compared_;
  Agreement result_{};
};

}  // namespace

double Agreement::trend_deviations() const {
  constexpr double kRoundoff = 1e-6;
  return std::fabs(trend) > kRoundoff ? trend / trend_error : 0;
}

bool Agreement::has_trend() const {
  constexpr double kSure = 3.5;  // of Student's t with seven degrees of freedom 1 % is beyond
  return std::fabs(trend_deviations()) > kSure;
}

std::vector<Agreement> compare_with_runs(const MeasuredVesicles& data,
                                         const std::vector<History>& runs) {
  if (runs.size() < 2)
    throw InputError("a comparison with measurements needs two finished runs at least");
  std::vector<Agreement> all;
  for (const Quantity quantity : kQuantities) all.push_back(Comparison(data, runs, quantity).run());
  return all;
}

SameKind same_kind(std::size_t runs) {
  const auto n = static_cast<double>(runs);
  return {(n - 1) / (n + 1), n > 3 ? std::sqrt((n - 1) / (n - 3)) : HUGE_VAL};
}

bool lies_beside(const Agreement& agreement, std::size_t runs) {
  constexpr int kFewest = 5;
  constexpr double kNextToNothing = 0.2;  // of what is to be expected
  constexpr double kMisfit = 3;           // errors of measuring may be larger than the range
  return agreement.measurements >= kFewest && agreement.misfit > kMisfit &&
         agreement.within < kNextToNothing * same_kind(runs).within * agreement.measurements;
}

double share_without_rafts(const MeasuredVesicles& data, const std::vector<History>& runs) {
  constexpr double kNone = 0.5;  // rafts
  double none = 0, all = 0;
  for (const Measurement& m : data.measurements)
    for (const History& run : runs) {
      if (!(m.time > 0) || m.time > run.time.back()) continue;
      none += run.at(Quantity::rafts, m.time) < kNone;
      ++all;
    }
  return all > 0 ? none / all : 0;
}

}  // namespace traceraft::observations
