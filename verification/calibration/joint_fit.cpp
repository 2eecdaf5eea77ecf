#include "verification/calibration/joint_fit.hpp"

#include <Eigen/LU>
#include <cmath>

#include "verification/likelihood/ensemble_likelihood.hpp"

namespace traceraft::calibration {
namespace {

using Kind = likelihood::FreeParameter::Kind;

// First what every fit has free, then the parameters that cost simulations.
class JointLikelihood {
 public:
  JointLikelihood(const Evidence& evidence, const RunEmulator& runs, const Box& box)
      : evidence_(evidence),
        runs_(runs),
        free_(evidence.observations, {&runs.at_point(0)}, evidence.unit),
        sought_(static_cast<Eigen::Index>(box.lower.size())) {
    const auto joined = [&](const Vec& first, const std::vector<double>& then) {
      Vec all(first.size() + sought_);
      all << first, Eigen::Map<const Vec>(then.data(), sought_);
      return all;
    };
    problem_ = {[this](const Vec& x) { return expand(x); }, joined(free_.lower, box.lower),
                joined(free_.upper, box.upper)};
  }

  JointFit from(const JointFit& start) const {
    Vec x(free_.lower.size() + sought_);
    x << free_.get(start.fit), Eigen::Map<const Vec>(start.ln_parameters.data(), sought_);
    const likelihood::ScoredMinimum found = likelihood::minimise_by_scoring(problem_, x);
    JointFit fit{sought(found.x), ensemble(found.x), deviations(found.at.hessian)};
    fit.fit.deviance = found.at.value;
    return fit;
  }

 private:
  // Where nothing is known they are large, not infinite.
  std::vector<double> deviations(Eigen::MatrixXd information) const {
    constexpr double kLeast = 1e-9;
    information.diagonal().array() += kLeast;
    const Vec variances = 2 * information.inverse().diagonal();
    const Vec own = variances.tail(sought_).cwiseMax(0).cwiseSqrt();
    return {own.data(), own.data() + own.size()};
  }
  std::vector<double> sought(const Vec& x) const {
    return {x.data() + free_.lower.size(), x.data() + x.size()};
  }
  likelihood::EnsembleFit ensemble(const Vec& x) const {
    likelihood::EnsembleFit fit;
    free_.set(x, fit);
    return fit;
  }

  likelihood::DevianceExpansion expand(const Vec& x) const {
    const std::vector<double> ln = sought(x);
    const likelihood::RunCurves curves = runs_.at(ln);
    std::vector<likelihood::RunCurves> derivatives;
    for (std::size_t i = 0; i < ln.size(); ++i) derivatives.push_back(runs_.derivative(ln, i));
    std::vector<likelihood::FreeParameter> all = free_.all;
    for (const likelihood::RunCurves& derivative : derivatives)
      all.push_back({Kind::curve, observations::Quantity::perimeter, &derivative});
    return likelihood::EnsembleLikelihood(evidence_.observations, {&curves}, evidence_.unit)
        .expand(ensemble(x), all);
  }

  const Evidence& evidence_;
  const RunEmulator& runs_;
  const likelihood::FreeParameters free_;
  const Eigen::Index sought_;
  likelihood::ScoringProblem problem_;
};

}  // namespace

JointFit fit_jointly(const Evidence& evidence, const RunEmulator& runs, const Box& box,
                     const std::vector<JointFit>& starts) {
  const JointLikelihood likelihood(evidence, runs, box);
  JointFit best;
  best.fit.deviance = HUGE_VAL;
  for (const JointFit& start : starts) {
    const JointFit fit = likelihood.from(start);
    if (fit.fit.deviance < best.fit.deviance) best = fit;
  }
  return best;
}

}  // namespace traceraft::calibration
