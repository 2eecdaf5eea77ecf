#include "verification/explain/rerun.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

namespace traceraft {
namespace {

constexpr double kOtherCells = 1.15;
constexpr char kOtherIntegrator[] = "rosenbrock";

}  // namespace

bool Rerun::confirms() const {
  if (!failure.empty()) return false;
  return found.heldout > 0 ? found.heldout < base.heldout : found.train < base.train;
}

Rerun run_again(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                const Explanation& found) {
  ExplainRequest other = request;
  other.cells = static_cast<int>(std::lround(kOtherCells * request.cells));
  other.filter.integrator = kOtherIntegrator;
  other.threads = 1;
  std::array<ModelGaps, 2> gaps;
  Rerun result;
  result.cells = other.cells;
  result.integrator = kOtherIntegrator;
  try {
    ThreadTeam(std::min(request.threads, 2)).run([&](int lane) {
      for (int k = lane; k < 2; k += std::min(request.threads, 2))
        gaps[k] = k == 0 ? gaps_of_model(series, other, found.base.pace, {}, found.noises)
                         : gaps_of_model(series, other, found.found.pace,
                                         found.found.hypothesis.terms(), found.noises);
    });
  } catch (const std::runtime_error& error) {
    result.failure = error.what();
  }
  result.base = gaps[0].gap;
  result.found = gaps[1].gap;
  result.floor = gaps[1].expected;
  return result;
}

ModelGaps gaps_of_model(const std::vector<FieldSeries>& series, const ExplainRequest& request,
                        double pace, const std::vector<EffectTerm>& effects,
                        const std::vector<std::vector<double>>& noises) {
  ExplainRequest alone = request;
  alone.filter.replicates = 0;
  FilterProblems data = problems_of(series, alone);
  if (!noises.empty())
    for (FilterProblem& vesicle : data) vesicle.noise = noises[vesicle.vesicle];
  std::vector<ErrorMaps> maps;
  const FilterResult pass =
      filter_fields(data, {with_effects(request.base, effects), pace, {}, {}}, alone.filter, maps);
  return {gaps_of_pass(pass), expected_gaps(pass)};
}

}  // namespace traceraft
