#include "verification/explain/refit.hpp"

#include <Eigen/Dense>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "verification/explain/free_parameters.hpp"

namespace traceraft {
namespace {

constexpr double kSmallStep = 0.1;  // in standard deviations
constexpr int kMostNewtonSteps = 6, kMostHalvings = 3;
// D is known to that factor at least.
constexpr double kLargestPaceStep = 0.5;

double square(double x) {
  return x * x;
}

// What is solved for: ln pace, then all coefficients; rates in units of time of the base model, as
// what data tell of a rate then hardly depends on the pace. Factors from coefficients to these:
Vec factors(const Hypothesis& hypothesis, double pace) {
  Vec result(1 + hypothesis.coefficients());
  result[0] = 1;
  Eigen::Index next = 1;
  for (const auto& part : hypothesis.parts)
    for (int d = 0; d < part.candidate.directions; ++d)
      result[next++] = part.candidate.rate ? pace : 1;
  return result;
}

Vec unknowns(const FilterModel& model) {
  Vec x = factors(model.hypothesis, model.pace);
  x[0] = std::log(model.pace);
  Eigen::Index next = 1;
  for (const auto& part : model.hypothesis.parts)
    for (const double a : part.coefficients) x[next++] *= a;
  return x;
}

void set_unknowns(FilterModel& model, const Vec& x) {
  model.pace = std::exp(x[0]);
  const Vec factor = factors(model.hypothesis, model.pace);
  Eigen::Index next = 1;
  for (auto& part : model.hypothesis.parts)
    for (double& a : part.coefficients) {
      a = part.candidate.within_range(x[next] / factor[next]);
      ++next;
    }
}

// Derivatives of the unknowns by ln pace and the coefficients.
Eigen::MatrixXd jacobian(const FilterModel& model) {
  const Vec x = unknowns(model);
  Eigen::MatrixXd J = factors(model.hypothesis, model.pace).asDiagonal();
  Eigen::Index next = 1;
  for (const auto& part : model.hypothesis.parts)
    for (int d = 0; d < part.candidate.directions; ++d, ++next)
      if (part.candidate.rate) J(next, 0) = x[next];
  return J;
}

// Of a refit, from that of its unknowns.
void set_covariance(const Eigen::MatrixXd& unknown, Refit& fit) {
  const Eigen::Index n = fit.hypothesis.coefficients();
  const Vec inverse = factors(fit.hypothesis, fit.pace).tail(n).cwiseInverse();
  fit.pace_deviation = std::sqrt(std::max(0.0, unknown(0, 0)));
  fit.covariance = inverse.asDiagonal() * unknown.bottomRightCorner(n, n) * inverse.asDiagonal();
}

// Where the pace and the coefficients are among the parameters of a pass.
std::vector<Eigen::Index> own_parameters(const Hypothesis& hypothesis) {
  std::vector<Eigen::Index> own{kPace};
  for (Eigen::Index k = 0; k < hypothesis.coefficients(); ++k) own.push_back(kFirstParameter + k);
  return own;
}

double squares_of_gap(const Innovation& in) {
  return in.noise.cwiseProduct(in.gap).squaredNorm();
}

struct Evaluation {
  double deviance = std::numeric_limits<double>::infinity();
  Vec step;                    // to the maximum in range, if the likelihood were Gaussian
  Eigen::MatrixXd covariance;  // of the unknowns
  Gaps gap, expected;
  std::vector<SnapshotGap> snapshots;
  std::string failure;
};

Gaps over_snapshots(const FilterResult& pass,
                    const std::function<double(const Innovation&)>& squares) {
  return {root_mean_square(pass.innovations, false, squares),
          root_mean_square(pass.innovations, true, squares)};
}

Evaluation evaluate(const FilterProblems& data, const FilterModel& model,
                    const FilterSettings& settings, std::vector<ErrorMaps>& maps) {
  Evaluation result;
  try {
    const FilterResult pass = filter_fields(data, model, settings, maps);
    const std::vector<Eigen::Index> free = free_parameters(pass, model.hypothesis);
    const Eigen::MatrixXd inverse = covariance_beside_held(pass.information, free);
    Vec all = Vec::Zero(pass.score.size());
    all(free) = newton_step(pass, free);
    const std::vector<Eigen::Index> own = own_parameters(model.hypothesis);
    const Eigen::MatrixXd J = jacobian(model);
    result.step = J * all(own);
    result.covariance = J * inverse(own, own) * J.transpose();
    // At the most probable error of the mesh, which the step takes to be free as well.
    result.deviance =
        pass.deviance - square(pass.score[kMeshError]) / pass.information(kMeshError, kMeshError);
    if (!std::isfinite(result.deviance)) throw std::runtime_error("its likelihood is no number");
    result.gap = gaps_of_pass(pass);
    result.expected = expected_gaps(pass);
    for (const Innovation& in : pass.innovations) {
      const auto count = static_cast<double>(in.values.size());
      result.snapshots.push_back({in.vesicle, in.snapshot, std::sqrt(squares_of_gap(in) / count),
                                  std::sqrt(in.expected_squares / count)});
    }
  } catch (const std::runtime_error& error) {
    result.failure = error.what();
  }
  return result;
}

// A curved valley is walked along in many steps of one direction, which may then be longer.
class StepLength {
 public:
  // For the next of the steps, in standard deviations.
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
bool settled(const Evaluation& here, const FilterModel& model) {
  const Vec x = unknowns(model);
  FilterModel moved = model;
  set_unknowns(moved, x + here.step);
  return ((unknowns(moved) - x).array().abs() <= kSmallStep * deviations(here).array()).all();
}

}  // namespace

std::optional<double> share_closed(double base, double found, double floor) {
  constexpr double kTold = 1.02;
  if (!(floor > 0 && base > kTold * floor)) return std::nullopt;
  return (square(base) - square(found)) / (square(base) - square(floor));
}

SharesClosed shares_closed(const Gaps& base, const Gaps& found, const Gaps& floor) {
  return {share_closed(base.train, found.train, floor.train),
          share_closed(base.heldout, found.heldout, floor.heldout)};
}

Gaps gaps_of_pass(const FilterResult& pass) {
  return over_snapshots(pass, squares_of_gap);
}

Gaps expected_gaps(const FilterResult& pass) {
  return over_snapshots(pass, [](const Innovation& in) { return in.expected_squares; });
}

Refit refit(const FilterProblems& data, const FilterModel& start, const FilterSettings& settings,
            const std::vector<ErrorMaps>& maps) {
  std::vector<ErrorMaps> kept = maps;
  FilterSettings alone = settings;
  alone.replicates = 0;
  FilterModel model = start;
  model.screened.clear();
  Vec first = unknowns(model);
  set_unknowns(model, first);
  Evaluation here = evaluate(data, model, alone, kept);
  for (int half = 0; half <= kMostHalvings && !here.failure.empty(); ++half) {
    first.tail(first.size() - 1) *= 0.5;
    set_unknowns(model, first);
    here = evaluate(data, model, alone, kept);
  }
  bool better = here.failure.empty();
  bool at_rest = better && settled(here, model);
  StepLength length;
  for (int k = 0; k < kMostNewtonSteps && better && !at_rest; ++k) {
    const double factor = length.next(here.step.cwiseQuotient(deviations(here)));
    Vec step = factor * here.step;
    step[0] = std::clamp(step[0], -kLargestPaceStep, kLargestPaceStep);
    const Vec x = unknowns(model);
    better = false;
    const int halvings = kMostHalvings + std::ilogb(factor);
    for (int half = 0; half <= halvings && !better; ++half, step *= 0.5) {
      FilterModel trial = model;
      set_unknowns(trial, x + step);
      Evaluation there = evaluate(data, trial, alone, kept);
      better = there.deviance < here.deviance;
      if (!better) continue;
      model = trial;
      here = std::move(there);
    }
    at_rest = settled(here, model);
  }
  Refit result;
  result.hypothesis = model.hypothesis;
  result.pace = model.pace;
  result.deviance = here.deviance;
  result.gap = here.gap;
  result.expected = here.expected;
  result.snapshots = here.snapshots;
  result.settled = at_rest;
  result.failure = here.failure;
  if (here.failure.empty()) set_covariance(here.covariance, result);
  return result;
}

double certainty(const Refit& fit, std::size_t effect) {
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < effect; ++k) first += fit.hypothesis.parts[k].candidate.directions;
  const auto& part = fit.hypothesis.parts[effect];
  const Eigen::Index n = part.candidate.directions;
  const Vec a = Eigen::Map<const Vec>(part.coefficients.data(), n);
  return a.dot(fit.covariance.block(first, first, n, n).ldlt().solve(a));
}

std::vector<Refit> refit_each(const FilterProblems& data, const std::vector<FilterModel>& starts,
                              const FilterSettings& settings, const std::vector<ErrorMaps>& maps,
                              const std::function<void(const Refit&)>& done) {
  std::vector<Refit> refits(starts.size());
  std::mutex one_at_a_time;
  const auto fit = [&](std::size_t k) {
    refits[k] = refit(data, starts[k], settings, maps);
    const std::lock_guard lock(one_at_a_time);
    done(refits[k]);
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

void bootstrap(const FilterResult& pass, const FilterModel& model, Refit& fit) {
  const Eigen::Index known = kFirstParameter + model.hypothesis.coefficients();
  if (pass.null_scores.cols() == 0) return;
  const Eigen::MatrixXd inverse = covariance_beside_held(
      pass.information.topLeftCorner(known, known), free_parameters(pass, model.hypothesis));
  const Eigen::MatrixXd estimates = inverse * pass.null_scores.topRows(known);
  // The replicates have no error of the mesh; one of its size moves the other estimates by that.
  const Vec by_mesh = inverse.col(kMeshError) / kMeshDoubt;
  const Eigen::MatrixXd covariance =
      estimates * estimates.transpose() / static_cast<double>(estimates.cols()) +
      by_mesh * by_mesh.transpose();
  const std::vector<Eigen::Index> own = own_parameters(model.hypothesis);
  const Eigen::MatrixXd J = jacobian(model);
  set_covariance(J * covariance(own, own) * J.transpose(), fit);
}

}  // namespace traceraft
