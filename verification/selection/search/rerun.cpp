#include "verification/selection/search/rerun.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "verification/assimilation/filter/noise_levels.hpp"
#include "verification/assimilation/filter/random_motion.hpp"

namespace traceraft::selection {
namespace {

constexpr double kOtherCells = 1.15;
constexpr char kOtherIntegrator[] = "rosenbrock";

// Standard deviations, beyond which one in a hundred truths falls short.
constexpr double kRefuted = 2.33;

std::vector<assimilation::Candidate> candidates_of(const assimilation::Hypothesis& hypothesis) {
  std::vector<assimilation::Candidate> own;
  for (const assimilation::Hypothesis::Part& part : hypothesis.parts) own.push_back(part.candidate);
  return own;
}

assimilation::FilterProblems problems_with(const std::optional<assimilation::NoiseModel>& noise,
                                           const std::vector<assimilation::FieldSeries>& series,
                                           const ExplainRequest& request,
                                           const assimilation::Hypothesis& hypothesis) {
  assimilation::FilterProblems data = problems_of(series, request);
  assimilation::set_random_effects(candidates_of(hypothesis), request.base, data);
  if (noise) assimilation::set_noise_model(*noise, request.base, request.filter, data);
  return data;
}

assimilation::FilterResult pass_of(const assimilation::FilterProblems& data,
                                   const assimilation::FilterModel& model,
                                   const assimilation::FilterSettings& settings) {
  std::vector<assimilation::ErrorMaps> maps;
  return assimilation::filter_fields(data, model, settings, maps);
}

assimilation::FilterResult pass_of_model(const assimilation::FilterProblems& data,
                                         const ExplainRequest& request, double diffusion_ratio,
                                         const assimilation::Hypothesis& hypothesis) {
  assimilation::FilterSettings alone = request.filter;
  alone.replicates = 0;
  return pass_of(data, {request.base, diffusion_ratio, hypothesis, {}}, alone);
}

assimilation::FilterResult pass_of_model(const assimilation::FilterProblems& data,
                                         const ExplainRequest& request, const Refit& fit) {
  return pass_of_model(data, request, fit.diffusion_ratio, fit.hypothesis);
}

// A pass per processor.
Rerun compare_both(assimilation::FilterProblems data, const ExplainRequest& other,
                   const Explanation& found) {
  const int lanes = std::min(other.threads, 2);
  for (assimilation::FilterProblem& vesicle : data) vesicle.team = std::make_shared<ThreadTeam>(1);
  std::array<assimilation::FilterResult, 2> passes;
  ThreadTeam(lanes).run([&](int lane) {
    for (int k = lane; k < 2; k += lanes)
      passes[k] = pass_of_model(data, other, k == 0 ? found.base : found.found);
  });
  return compare_forecasts(passes[0], passes[1], found.rounds.back().screening.mesh_error);
}

// Is what nothing explains there on the other mesh, too? As the search asks it, of the model that
// it ended with.
void look_for_gap(const assimilation::FilterProblems& data, const ExplainRequest& other,
                  Explanation& found, Rerun& rerun) {
  const Refit& end = found.found;
  const assimilation::FilterResult pass =
      pass_of(data, {other.base, end.diffusion_ratio, end.hypothesis, {}}, other.filter);
  if (end.hypothesis.added() == 0) {
    rerun.base = rerun.found = assimilation::gaps_of_pass(pass);
    rerun.floor = assimilation::expected_gaps(pass);
  }
  const Screening left = screen(pass, {}, end.hypothesis);
  rerun.gap_p = left.gap_p;
  if (!has_gap(left, other.false_alarms)) found.finding = found.without_gap;
}

// An action that fails says why.
template <class Action>
void attempt(std::string& why, const Action& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    why = error.what();
  }
}

}  // namespace

bool Rerun::refutes() const {
  return failure.empty() && gain < 0 && shortfall > kRefuted + doubt;
}

Rerun compare_forecasts(const assimilation::FilterResult& base,
                        const assimilation::FilterResult& found, double mesh_error) {
  Rerun result;
  result.base = assimilation::gaps_of_pass(base);
  result.found = assimilation::gaps_of_pass(found);
  result.floor = assimilation::expected_gaps(found);
  const bool held_out = result.heldout();
  // If the found model is the truth, its innovations ν have the covariance S; νᵀ S⁻¹ d has the
  // variance dᵀ S⁻¹ d then, d being the difference of the forecasts.
  double along = 0, difference = 0, count = 0;
  assimilation::VarianceGain random;
  for (std::size_t k = 0; k < found.innovations.size(); ++k) {
    const assimilation::Innovation& f = found.innovations[k];
    if (f.held_out != held_out) continue;
    count += static_cast<double>(f.values.size());
    assimilation::Columns values(f.values.size(), 2);
    values << f.values, base.innovations[k].values - f.values;
    const assimilation::InnovationCovariance weight(f, 0);
    const assimilation::Columns weighted = weight.solve(values);
    const double one = values.col(1).dot(weighted.col(0)), two = values.col(1).dot(weighted.col(1));
    result.gain += 2 * one + two;
    along -= one;
    difference += two;
    const assimilation::VarianceGain own = assimilation::variance_gain(f, weight);
    random.gain += own.gain;
    random.mean += own.mean;
    random.variance += own.variance;
  }
  result.gain += random.gain;
  // The mean of the gain less the gain, which has the variance 4 dᵀ S⁻¹ d by the forecasts.
  const double short_of = 2 * along + random.mean - random.gain,
               variance = 4 * difference + random.variance;
  result.shortfall = variance > 0 ? short_of / std::sqrt(variance) : 0;
  result.doubt = mesh_doubt(count, mesh_error);
  return result;
}

bool is_to_run_again(const Explanation& found) {
  return found.found.hypothesis.added() > 0 || found.finding == Finding::unnamed;
}

void run_again(const std::vector<assimilation::FieldSeries>& series, const ExplainRequest& request,
               Explanation& found) {
  if (!is_to_run_again(found)) return;
  ExplainRequest other = request;
  other.cells = static_cast<int>(std::lround(kOtherCells * request.cells));
  other.filter.integrator = kOtherIntegrator;
  const bool asks_for_gap = found.finding == Finding::unnamed;
  if (!asks_for_gap) other.filter.replicates = 0;
  Rerun result;
  std::optional<assimilation::FilterProblems> data;
  std::string no_data;
  attempt(no_data,
          [&] { data = problems_with(found.noise_model, series, other, found.found.hypothesis); });
  if (found.found.hypothesis.added() > 0) {
    result.failure = no_data;
    if (data) attempt(result.failure, [&] { result = compare_both(*data, other, found); });
  }
  if (asks_for_gap) {
    result.gap_failure = no_data;
    if (data) attempt(result.gap_failure, [&] { look_for_gap(*data, other, found, result); });
  }
  result.cells = other.cells;
  result.integrator = kOtherIntegrator;
  if (is_named(found) && result.refutes())
    found.finding = without_name(found.rounds.front().screening, request.false_alarms);
  found.rerun = result;
}

ModelGaps gaps_of_model(const std::vector<assimilation::FieldSeries>& series,
                        const ExplainRequest& request, double diffusion_ratio,
                        const std::vector<effects::EffectTerm>& effects,
                        const std::optional<assimilation::NoiseModel>& noise) {
  ExplainRequest alone = request;
  alone.filter.replicates = 0;
  const assimilation::Hypothesis hypothesis = assimilation::of_model(effects);
  const assimilation::FilterResult pass = pass_of_model(
      problems_with(noise, series, alone, hypothesis), alone, diffusion_ratio, hypothesis);
  return {assimilation::gaps_of_pass(pass), assimilation::expected_gaps(pass)};
}

}  // namespace traceraft::selection
