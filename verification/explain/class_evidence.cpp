#include "verification/explain/class_evidence.hpp"

#include <algorithm>
#include <stdexcept>

#include "verification/explain/judgement.hpp"

namespace traceraft {
namespace {

std::optional<double> criterion_of(const FilterProblems& data, FilterModel model,
                                   const FilterSettings& settings) {
  try {
    std::vector<ErrorMaps> maps;
    (void)filter_fields(data, model, settings, maps);
    const Refit fit = refit(data, model, settings, maps);
    if (!fit.failure.empty()) return {};
    return criterion(fit, count_values(data));
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace

bool holds_out(const FilterProblems& data) {
  return std::any_of(data.begin(), data.end(), [](const FilterProblem& vesicle) {
    return vesicle.train < vesicle.snapshots.size();
  });
}

FilterProblems holding_nothing_out(FilterProblems data) {
  for (FilterProblem& vesicle : data) vesicle.train = vesicle.snapshots.size();
  return data;
}

double count_values(const FilterProblems& data) {
  double count = 0;
  for (const FilterProblem& vesicle : data)
    for (std::size_t k = 1; k < vesicle.train; ++k)
      count += static_cast<double>(vesicle.snapshots[k].values.size());
  return count;
}

std::vector<std::optional<double>> criteria_of(const FilterProblems& data,
                                               const CahnHilliardModel& base,
                                               const std::vector<Refit>& members,
                                               FilterSettings settings) {
  settings.replicates = 0;
  std::vector<std::optional<double>> criteria;
  for (const Refit& member : members)
    criteria.push_back(criterion_of(data, {base, member.pace, member.hypothesis, {}}, settings));
  return criteria;
}

}  // namespace traceraft
