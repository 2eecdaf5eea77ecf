#include "verification/selection/fit/refit.hpp"

#include <Eigen/Dense>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "verification/selection/fit/free_parameters.hpp"
#include "verification/selection/fit/refit_unknowns.hpp"

namespace traceraft::selection {
namespace {

constexpr double kSmallStep = 0.1;  // in standard deviations
constexpr int kMostNewtonSteps = 8, kMostHalvings = 3;
// D is known to that factor at least.
constexpr double kLargestDiffusionRatioStep = 0.5;

// Sets the covariance of a refit from that of its unknowns.
void set_covariance(const Eigen::MatrixXd& unknown, Refit& fit) {
  const Eigen::Index n = fit.hypothesis.coefficients();
  const Vec inverse = unknown_factors(fit.hypothesis, fit.diffusion_ratio).tail(n).cwiseInverse();
  fit.diffusion_ratio_deviation = std::sqrt(std::max(0.0, unknown(0, 0)));
  fit.covariance = inverse.asDiagonal() * unknown.bottomRightCorner(n, n) * inverse.asDiagonal();
}

assimilation::Gaps without_random(const assimilation::Gaps& gaps, const Refit& fit) {
  const auto rest = [](double all, double random) {
    return std::sqrt(std::max(0.0, all * all - random * random));
  };
  return {rest(gaps.train, fit.random.train), rest(gaps.heldout, fit.random.heldout)};
}

// The evaluation of a model as it is.
struct Evaluation {
  Refit fit;
  Vec step;                         // to the maximum in range, if the likelihood were Gaussian
  double diffusion_ratio_step = 0;  // of the first unknown, likewise, if the others stay
  Eigen::MatrixXd covariance;       // of the unknowns
};

Evaluation evaluate(const assimilation::FilterProblems& data,
                    const assimilation::FilterModel& model,
                    const assimilation::FilterSettings& settings,
                    std::vector<assimilation::ErrorMaps>& maps) {
  Evaluation result;
  Refit& fit = result.fit;
  fit.hypothesis = model.hypothesis;
  fit.diffusion_ratio = model.diffusion_ratio;
  try {
    const assimilation::FilterResult pass =
        assimilation::filter_fields(data, model, settings, maps);
    const std::vector<Eigen::Index> free = free_parameters(pass, model.hypothesis);
    const Eigen::MatrixXd inverse = covariance_beside_held(pass.information, free);
    Vec all = Vec::Zero(pass.score.size());
    all(free) = newton_step(pass, free);
    const std::vector<Eigen::Index> own = own_parameters(model.hypothesis);
    const Eigen::MatrixXd J = unknown_derivatives(model);
    result.step = J * all(own);
    result.covariance = J * inverse(own, own) * J.transpose();
    result.diffusion_ratio_step =
        newton_step(pass, {assimilation::kDiffusionRatio, assimilation::kMeshError})[0];
    // The deviance is that at the most probable error of the mesh, which the step takes to be free
    // as well.
    fit.deviance =
        pass.deviance - std::pow(pass.score[assimilation::kMeshError], 2) /
                            pass.information(assimilation::kMeshError, assimilation::kMeshError);
    if (!std::isfinite(fit.deviance)) throw std::runtime_error("its likelihood is not a number");
    fit.gap = assimilation::gaps_of_pass(pass);
    fit.expected = assimilation::expected_gaps(pass);
    fit.random = assimilation::random_gaps(pass);
    fit.snapshots = assimilation::snapshot_gaps(pass);
    set_covariance(result.covariance, fit);
  } catch (const std::runtime_error& error) {
    fit.deviance = std::numeric_limits<double>::infinity();
    fit.failure = error.what();
  }
  return result;
}

// A curved valley is walked along in many steps of one direction, which may then be longer.
class StepLength {
 public:
  // The length of the next one of the steps, as a factor; `step`: in standard deviations.
  double next(const Vec& step) {
    const bool ahead = last_.size() > 0 && step.dot(last_) > kAhead * step.norm() * last_.norm();
    length_ = ahead ? std::min(2 * length_, kLongest) : 1;
    last_ = step;
    return length_;
  }

 private:
  static constexpr double kAhead = 0.9, kLongest = 8;
  Vec last_;
  double length_ = 1;
};

Vec deviations(const Evaluation& here) {
  return here.covariance.diagonal().cwiseMax(0).cwiseSqrt();
}

// Steps this short change nothing that is reported.
bool settled(const Evaluation& here, const assimilation::FilterModel& model) {
  const Vec x = unknowns(model);
  assimilation::FilterModel moved = model;
  set_unknowns(moved, x + here.step);
  return ((unknowns(moved) - x).array().abs() <= kSmallStep * deviations(here).array()).all();
}

class NewtonSearch {
 public:
  NewtonSearch(const assimilation::FilterProblems& data, const assimilation::FilterModel& start,
               const assimilation::FilterSettings& settings,
               const std::vector<assimilation::ErrorMaps>& maps)
      : data_(data), settings_(settings), maps_(maps), model_(start) {
    settings_.replicates = 0;
    model_.screened.clear();
  }

  Refit run() {
    begin();
    Refit& found = here_.fit;
    found.settled = found.failure.empty() && settled(here_, model_);
    StepLength length;
    for (int k = 0; k < kMostNewtonSteps && found.failure.empty() && !found.settled; ++k) {
      const bool better = step(length.next(here_.step.cwiseQuotient(deviations(here_))));
      found.settled = settled(here_, model_);
      if (!better) break;
    }
    if (found.failure.empty() && model_.hypothesis.is_random()) found.random_gain = random_gain();
    return std::move(found);
  }

 private:
  Evaluation evaluated(const assimilation::FilterModel& model) {
    return evaluate(data_, model, settings_, maps_);
  }

  // Where the model to start from cannot be advanced, its effects are weakened until one can.
  void begin() {
    set_unknowns(model_, unknowns(model_));
    here_ = evaluated(model_);
    for (int half = 0; half <= kMostHalvings && !here_.fit.failure.empty(); ++half) {
      model_ = with_strengths(0.5, model_);
      here_ = evaluated(model_);
    }
  }

  double random_gain() {
    assimilation::FilterModel without = model_;
    for (assimilation::Hypothesis::Part& part : without.hypothesis.parts)
      if (part.candidate.random) part.coefficients.front() = 0;
    return evaluated(without).fit.deviance - here_.fit.deviance;
  }

  // So many times the step, or half of that, ...: false if none is better than here. Where D makes
  // up for an effect the way is a curved valley: beside its bottom, the diffusion ratio leads back
  // to it.
  bool step(double factor) {
    Vec step = factor * here_.step;
    step[0] = std::clamp(step[0], -kLargestDiffusionRatioStep, kLargestDiffusionRatioStep);
    const Vec x = unknowns(model_);
    const double before = here_.fit.deviance;
    const int halvings = kMostHalvings + std::ilogb(factor);
    for (int half = 0; half <= halvings; ++half, step *= 0.5) {
      Vec to = x + step;
      const double diffusion_ratio_step = go_if_better(to);
      to[0] +=
          std::clamp(diffusion_ratio_step, -kLargestDiffusionRatioStep, kLargestDiffusionRatioStep);
      if (diffusion_ratio_step != 0) go_if_better(to);
      if (here_.fit.deviance < before) return true;
    }
    return false;
  }

  // Returns by what the diffusion ratio would have to change there if it is no better; 0 if it
  // cannot be evaluated.
  double go_if_better(const Vec& x) {
    assimilation::FilterModel trial = model_;
    set_unknowns(trial, x);
    Evaluation there = evaluated(trial);
    if (!(there.fit.deviance < here_.fit.deviance)) return there.diffusion_ratio_step;
    model_ = std::move(trial);
    here_ = std::move(there);
    return 0;
  }

  const assimilation::FilterProblems& data_;
  assimilation::FilterSettings settings_;
  std::vector<assimilation::ErrorMaps> maps_;
  assimilation::FilterModel model_;
  Evaluation here_;
};

}  // namespace

Refit refit(const assimilation::FilterProblems& data, const assimilation::FilterModel& start,
            const assimilation::FilterSettings& settings,
            const std::vector<assimilation::ErrorMaps>& maps) {
  return NewtonSearch(data, start, settings, maps).run();
}

assimilation::SharesClosed shares_closed(const Refit& base, const Refit& fit) {
  return assimilation::shares_closed(without_random(base.gap, base), without_random(fit.gap, fit),
                                     without_random(fit.expected, fit));
}

double certainty(const Refit& fit, std::size_t effect) {
  if (fit.hypothesis.parts[effect].candidate.random) return fit.random_gain;
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < effect; ++k) first += fit.hypothesis.parts[k].candidate.directions;
  const auto& part = fit.hypothesis.parts[effect];
  const Eigen::Index n = part.candidate.directions;
  const Vec a = Eigen::Map<const Vec>(part.coefficients.data(), n);
  return a.dot(fit.covariance.block(first, first, n, n).ldlt().solve(a));
}

Refit no_worse(const Refit& fit, const Refit& without) {
  if (fit.deviance <= without.deviance) return fit;
  Refit result = without;
  result.hypothesis.parts.push_back(fit.hypothesis.parts.back());
  std::vector<double>& coefficients = result.hypothesis.parts.back().coefficients;
  coefficients.assign(coefficients.size(), 0);
  const Eigen::Index known = without.covariance.rows(), all = result.hypothesis.coefficients();
  result.covariance = Eigen::MatrixXd::Zero(all, all);  // of what is nothing nothing is known
  result.covariance.topLeftCorner(known, known) = without.covariance;
  return result;
}

std::vector<Refit> refit_each(const assimilation::FilterProblems& data,
                              const std::vector<assimilation::FilterModel>& starts,
                              const assimilation::FilterSettings& settings,
                              const std::vector<assimilation::ErrorMaps>& maps,
                              const std::function<void(std::size_t, const Refit&)>& done) {
  std::vector<Refit> refits(starts.size());
  std::mutex one_at_a_time;
  const auto fit = [&](std::size_t k) {
    refits[k] = refit(data, starts[k], settings, maps);
    const std::lock_guard lock(one_at_a_time);
    done(k, refits[k]);
  };
  if (starts.size() == 1) {
    fit(0);  // which uses all processors itself
    return refits;
  }
  std::atomic<std::size_t> next{0};
  data.front().team->run([&](int) {
    for (std::size_t k = next++; k < starts.size(); k = next++) fit(k);
  });
  return refits;
}

void bootstrap(const assimilation::FilterResult& pass, const assimilation::FilterModel& model,
               Refit& fit) {
  const Eigen::Index known = assimilation::kFirstParameter + model.hypothesis.coefficients();
  if (pass.null_scores.cols() == 0) return;
  const Eigen::MatrixXd inverse = covariance_beside_held(
      pass.information.topLeftCorner(known, known), free_parameters(pass, model.hypothesis));
  const Eigen::MatrixXd estimates = inverse * pass.null_scores.topRows(known);
  // The replicates have no error of the mesh; one of its size moves the other estimates by that.
  const Vec by_mesh = inverse.col(assimilation::kMeshError) / assimilation::kMeshDoubt;
  const Eigen::MatrixXd covariance =
      estimates * estimates.transpose() / static_cast<double>(estimates.cols()) +
      by_mesh * by_mesh.transpose();
  const std::vector<Eigen::Index> own = own_parameters(model.hypothesis);
  const Eigen::MatrixXd J = unknown_derivatives(model);
  set_covariance(J * covariance(own, own) * J.transpose(), fit);
}

}  // namespace traceraft::selection
