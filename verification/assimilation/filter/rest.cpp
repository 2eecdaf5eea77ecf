#include "verification/assimilation/filter/rest.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "verification/assimilation/fields/registration.hpp"

namespace traceraft::assimilation {
namespace {

// Root mean square of changes beyond noise that are none, in units of the distance of the phases:
// about what meshes of the usual sizes make of a boundary that another rotation moves over them.
constexpr double kStill = 0.01;
// Standard deviations that the variance of so many values may be above its mean.
constexpr double kChance = 3;
constexpr double kMuchSlower = 0.1, kMuchFaster = 10;
constexpr int kDraws = 8;

// A field at the points of a snapshot, turned and scaled so that it is most like the values.
Vec fitted(const FilterProblem& data, const Vec& field, std::size_t snapshot) {
  const FieldSnapshot& measured = data.series.snapshots[snapshot];
  Vec at = data.snapshots[snapshot].trace * field;
  if (data.sphere) {
    const SphereMap map(*data.space, field);
    const Eigen::Matrix3d back =
        most_alike_rotation(map, measured.points, measured.values).transpose();
    for (Eigen::Index i = 0; i < at.size(); ++i)
      at[i] = map.at(back * measured.points[static_cast<std::size_t>(i)]);
  }
  const Vec centred = at.array() - at.mean();
  const double mean = measured.values.mean();
  const double slope = centred.dot(measured.values) / centred.squaredNorm();
  return (slope * centred).array() + mean;
}

class Interval {
 public:
  Interval(const FilterProblem& data, const problem::CahnHilliardModel& base, std::size_t snapshot)
      : data_(data), base_(base), snapshot_(snapshot) {
    ErrorRequest wanted;
    wanted.draws = kDraws;
    wanted.stream = data.vesicle;
    before_ = estimate_field(*data.space, data.snapshots[snapshot - 1], data.prior, wanted);
  }

  // The variance of values around the field before, if nothing has changed: noise and the error of
  // that field.
  double chance() const {
    const NoisyValues& now = data_.snapshots[snapshot_];
    const double noise =
        data_.noise[snapshot_] * data_.noise[snapshot_] * now.deviation.squaredNorm();
    const double error = (now.trace * before_.draws).squaredNorm() / kDraws;
    return (noise + error) / static_cast<double>(now.values.size());
  }

  bool unchanged() const { return is_still(fitted(data_, before_.field, snapshot_)); }

  bool is_still(const Vec& expected) const {
    const Vec& values = data_.series.snapshots[snapshot_].values;
    const auto count = static_cast<double>(values.size());
    const double width = base_.well.b - base_.well.a, noise = chance();
    const double excess = (values - expected).squaredNorm() / count - noise;
    return excess <= kStill * kStill * width * width + kChance * noise * std::sqrt(2 / count);
  }

  // The model's forecast as the microscope would see it.
  Vec expected(double diffusion_ratio) const {
    const problem::CahnHilliard problem(data_.space, problem::without_noise(base_));
    const double start = data_.time(snapshot_ - 1),
                 time = diffusion_ratio * (data_.time(snapshot_) - start);
    const Vec end = advanced(data_, problem, before_.field, start, start + time);
    return fitted(data_, data_.blur ? data_.blur->blurred(end) : end, snapshot_);
  }

  bool model_rests() const {
    const Vec usual = expected(1);
    if (!is_still(usual)) return false;
    const double width = base_.well.b - base_.well.a;
    for (const double diffusion_ratio : {kMuchSlower, kMuchFaster}) {
      const Vec other = expected(diffusion_ratio);
      const double change = (other - usual).norm() / std::sqrt(static_cast<double>(usual.size()));
      if (change > kStill * width) return false;
    }
    return true;
  }

 private:
  const FilterProblem& data_;
  const problem::CahnHilliardModel& base_;
  std::size_t snapshot_;
  FieldEstimate before_;
};

}  // namespace

bool are_at_rest(const FilterProblems& data, const problem::CahnHilliardModel& base) {
  const auto all_intervals = [&](const auto& holds) {
    for (const FilterProblem& vesicle : data)
      for (std::size_t k = 1; k < vesicle.snapshots.size(); ++k)
        if (!holds(Interval(vesicle, base, k))) return false;
    return true;
  };
  try {
    return all_intervals([](const Interval& i) { return i.unchanged(); }) &&
           all_intervals([](const Interval& i) { return i.model_rests(); });
  } catch (const std::runtime_error&) {
    return false;  // D of the base model may be far from that of the data.
  }
}

}  // namespace traceraft::assimilation
