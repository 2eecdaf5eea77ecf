#include "verification/explain/rerun.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

namespace traceraft {
namespace {

constexpr double kOtherCells = 1.15;
constexpr char kOtherIntegrator[] = "rosenbrock";

// Standard deviations, beyond which one in a hundred truths falls short.
constexpr double kRefuted = 2.33;

FilterResult pass_of(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                     const FilterModel& model, const std::vector<std::vector<double>>& noises) {
  FilterProblems data = problems_of(series, request);
  if (!noises.empty())
    for (FilterProblem& vesicle : data) vesicle.noise = noises[vesicle.vesicle];
  std::vector<ErrorMaps> maps;
  return filter_fields(data, model, request.filter, maps);
}

FilterResult pass_of_model(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                           double pace, const std::vector<EffectTerm>& effects,
                           const std::vector<std::vector<double>>& noises) {
  ExplainRequest alone = request;
  alone.filter.replicates = 0;
  return pass_of(series, alone, {with_effects(request.base, effects), pace, {}, {}}, noises);
}

// As the search asks it, of the model that it ended with.
Screening what_is_left(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                       const Explanation& found) {
  const Refit& end = found.found;
  const FilterModel model{request.base, end.pace, end.hypothesis, {}};
  return screen(pass_of(series, request, model, found.noises), {}, end.hypothesis);
}

}  // namespace

bool Rerun::refutes() const {
  return failure.empty() && gain < 0 && shortfall > kRefuted;
}

Rerun compare_forecasts(const FilterResult& base, const FilterResult& found) {
  Rerun result;
  result.base = gaps_of_pass(base);
  result.found = gaps_of_pass(found);
  result.floor = expected_gaps(found);
  const bool held_out = result.found.heldout > 0;
  // The found model's gap g and the difference d of the forecasts are independent if it is the
  // truth: Σ g d / σ has the variance Σ d².
  double along = 0, difference = 0;
  for (std::size_t k = 0; k < found.innovations.size(); ++k) {
    const Innovation &b = base.innovations[k], &f = found.innovations[k];
    if (f.held_out != held_out) continue;
    const Vec without = b.noise.cwiseProduct(b.gap), with = f.noise.cwiseProduct(f.gap);
    const double variance = f.expected_squares / static_cast<double>(f.values.size());
    result.gain += (without.squaredNorm() - with.squaredNorm()) / variance;
    along += with.dot(with - without) / variance;
    difference += (with - without).squaredNorm() / variance;
  }
  result.shortfall = difference > 0 ? along / std::sqrt(difference) : 0;
  return result;
}

void run_again(const std::vector<FieldSeries>& series, const ExplainRequest& request,
               Explanation& found) {
  if (found.found.hypothesis.parts.empty()) return;
  ExplainRequest other = request;
  other.cells = static_cast<int>(std::lround(kOtherCells * request.cells));
  other.filter.integrator = kOtherIntegrator;
  other.threads = 1;
  std::array<FilterResult, 2> passes;
  Rerun result;
  try {
    ThreadTeam(std::min(request.threads, 2)).run([&](int lane) {
      for (int k = lane; k < 2; k += std::min(request.threads, 2))
        passes[k] = k == 0 ? pass_of_model(series, other, found.base.pace, {}, found.noises)
                           : pass_of_model(series, other, found.found.pace,
                                           found.found.hypothesis.terms(), found.noises);
    });
    result = compare_forecasts(passes[0], passes[1]);
    if (found.finding == Finding::unnamed) {
      other.threads = request.threads;
      const Screening left = what_is_left(series, other, found);
      result.gap_p = left.gap_p;
      if (!has_gap(left, found.false_alarms))
        found.finding = found.rivals.empty() ? Finding::named : Finding::ambiguous;
    }
  } catch (const std::runtime_error& error) {
    result.failure = error.what();
  }
  result.cells = other.cells;
  result.integrator = kOtherIntegrator;
  if (is_named(found) && result.refutes())
    found.finding = without_name(found.rounds.front().screening, found.false_alarms);
  found.rerun = result;
}

ModelGaps gaps_of_model(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                        double pace, const std::vector<EffectTerm>& effects,
                        const std::vector<std::vector<double>>& noises) {
  const FilterResult pass = pass_of_model(series, request, pace, effects, noises);
  return {gaps_of_pass(pass), expected_gaps(pass)};
}

}  // namespace traceraft
