#include "verification/explain/refit.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace traceraft {
namespace {

constexpr double kSmallStep = 0.1;  // in standard deviations
constexpr int kMostSteps = 6, kMostHalvings = 3;
// D is known to that factor at least.
constexpr double kLargestPaceStep = 0.5;

// ln pace first, then all coefficients.
Vec unknowns(const FilterModel& model) {
  Vec x(1 + model.hypothesis.coefficients());
  x[0] = std::log(model.pace);
  Eigen::Index next = 1;
  for (const auto& part : model.hypothesis.parts)
    for (const double a : part.coefficients) x[next++] = a;
  return x;
}

void set_unknowns(FilterModel& model, const Vec& x) {
  model.pace = std::exp(x[0]);
  Eigen::Index next = 1;
  for (auto& part : model.hypothesis.parts)
    for (double& a : part.coefficients) {
      a = part.candidate.two_sided ? x[next] : std::max(0.0, x[next]);
      ++next;
    }
}

struct Evaluation {
  double deviance = std::numeric_limits<double>::infinity();
  Vec step;                    // to the maximum, if the likelihood were Gaussian
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
    const Eigen::MatrixXd inverse = pass.information.selfadjointView<Eigen::Lower>().ldlt().solve(
        Eigen::MatrixXd::Identity(pass.information.rows(), pass.information.cols()));
    const Vec all = inverse * pass.score;
    std::vector<Eigen::Index> own{kPace};
    for (Eigen::Index k = 0; k < model.hypothesis.coefficients(); ++k)
      own.push_back(kFirstParameter + k);
    result.step = all(own);
    result.covariance = inverse(own, own);
    result.deviance = pass.deviance;
    result.gap = gaps_of_pass(pass);
    result.expected = expected_gaps(pass);
    for (const Innovation& in : pass.innovations) {
      const auto count = static_cast<double>(in.values.size());
      result.snapshots.push_back({in.vesicle, in.snapshot, in.values.norm() / std::sqrt(count),
                                  std::sqrt(in.expected_squares / count)});
    }
  } catch (const std::runtime_error& error) {
    result.failure = error.what();
  }
  return result;
}

// Steps this short change nothing that is reported.
bool settled(const Evaluation& here, const FilterModel& model) {
  const Vec x = unknowns(model);
  FilterModel moved = model;
  set_unknowns(moved, x + here.step);
  const Vec deviation = here.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  return ((unknowns(moved) - x).array().abs() <= kSmallStep * deviation.array()).all();
}

}  // namespace

Gaps gaps_of_pass(const FilterResult& pass) {
  return over_snapshots(pass, [](const Innovation& in) { return in.values.squaredNorm(); });
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
  Evaluation here = evaluate(data, model, alone, kept);
  bool better = here.failure.empty();
  for (int k = 0; k < kMostSteps && better && !settled(here, model); ++k) {
    Vec step = here.step;
    step[0] = std::clamp(step[0], -kLargestPaceStep, kLargestPaceStep);
    const Vec x = unknowns(model);
    better = false;
    for (int half = 0; half <= kMostHalvings && !better; ++half, step *= 0.5) {
      FilterModel trial = model;
      set_unknowns(trial, x + step);
      Evaluation there = evaluate(data, trial, alone, kept);
      better = there.deviance < here.deviance;
      if (!better) continue;
      model = trial;
      here = std::move(there);
    }
  }
  Refit result;
  result.hypothesis = model.hypothesis;
  result.pace = model.pace;
  result.deviance = here.deviance;
  result.gap = here.gap;
  result.expected = here.expected;
  result.snapshots = here.snapshots;
  result.failure = here.failure;
  if (here.failure.empty()) {
    const Eigen::Index n = model.hypothesis.coefficients();
    result.pace_deviation = std::sqrt(std::max(0.0, here.covariance(0, 0)));
    result.covariance = here.covariance.bottomRightCorner(n, n);
  }
  return result;
}

}  // namespace traceraft
