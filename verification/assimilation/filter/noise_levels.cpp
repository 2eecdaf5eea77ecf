#include "verification/assimilation/filter/noise_levels.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::assimilation {
namespace {

// Deviations that snapshots state are believed, relative to each other, as far as that factor.
constexpr double kBelieved = 1.25;

// The noise of all snapshots. `own`: that of each but the first, whose own nobody knows; `train` of
// all count.
std::vector<double> believed(const std::vector<double>& own, std::size_t train) {
  const std::vector<double> counting(own.begin(),
                                     own.begin() + static_cast<std::ptrdiff_t>(train) - 1);
  std::vector<double> sorted = counting;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  double squares = 0, count = 0;
  for (const double noise : counting)
    if (noise < kBelieved * usual && noise > usual / kBelieved) {
      squares += noise * noise;
      ++count;
    }
  const double common = std::sqrt(squares / count);
  std::vector<double> result{common};
  for (const double noise : own)
    result.push_back(noise < kBelieved * usual && noise > usual / kBelieved ? common : noise);
  return result;
}

}  // namespace

double noise_of(const FilterProblems& problems) {
  double squares = 0, count = 0;
  for (const FilterProblem& data : problems)
    for (std::size_t k = 1; k < data.train; ++k) {  // nobody knows that of the first
      const Vec& deviation = data.snapshots[k].deviation;
      squares += data.noise[k] * data.noise[k] * deviation.squaredNorm();
      count += static_cast<double>(deviation.size());
    }
  return std::sqrt(squares / count);
}

double contrast_of(const FilterProblems& data) {
  const double noise = noise_of(data);
  double sum = 0, squares = 0, count = 0;
  for (const FilterProblem& vesicle : data)
    for (const FieldSnapshot& snapshot : vesicle.series.snapshots) {
      sum += snapshot.values.sum();
      squares += snapshot.values.squaredNorm();
      count += static_cast<double>(snapshot.values.size());
    }
  return std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count) - noise * noise));
}

void fit_noise(FilterProblems& data, const FilterResult& pass) {
  std::vector<std::vector<double>> own(data.size());
  for (const Innovation& in : pass.innovations) {
    const double squares = in.weighted_squares / static_cast<double>(in.values.size());
    own[in.vesicle].push_back(data[in.vesicle].noise[in.snapshot] * std::sqrt(squares));
  }
  set_noise(data, own);
}

void set_noise(FilterProblems& data, const std::vector<std::vector<double>>& own) {
  for (FilterProblem& vesicle : data) vesicle.noise = believed(own[vesicle.vesicle], vesicle.train);
}

}  // namespace traceraft::assimilation
