#include "verification/observations/history.hpp"

#include <algorithm>
#include <cmath>

#include "verification/statistics/sample.hpp"

namespace traceraft::observations {

QuantityName name_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::perimeter:
      return {"perimeter", "perimeter / radius"};
    case Quantity::rafts:
      return {"rafts", "number of rafts"};
    default:
      return {"fraction", "raft area fraction"};
  }
}

double History::at(Quantity quantity, double t) const {
  const std::vector<double>& y = of(quantity);
  const auto after = std::upper_bound(time.begin(), time.end(), t);
  if (after == time.begin()) return y.front();
  const std::size_t i = static_cast<std::size_t>(after - time.begin()) - 1;
  if (after == time.end() || quantity == Quantity::rafts) return y[i];
  return y[i] + (y[i + 1] - y[i]) * (t - time[i]) / (time[i + 1] - time[i]);
}

double logarithm_of(Quantity quantity, double value) {
  constexpr std::array<double, 3> kLeast = {0.5, 0.5, 0.0016};
  return std::log(std::max(value, kLeast[index_of(quantity)]));
}

std::vector<double> common_times(const std::vector<History>& histories, int per_decade) {
  double begin = 0, end = HUGE_VAL;
  for (const History& history : histories) {
    const auto first = std::upper_bound(history.time.begin(), history.time.end(), 0.0);
    begin = std::max(begin, first == history.time.end() ? HUGE_VAL : *first);
    end = std::min(end, history.time.empty() ? 0.0 : history.time.back());
  }
  std::vector<double> times;
  if (histories.empty() || !(begin < end)) return times;
  const int steps = static_cast<int>(std::ceil(std::log10(end / begin) * per_decade));
  for (int i = 0; i <= steps; ++i) times.push_back(begin * std::pow(end / begin, i * 1.0 / steps));
  times.back() = end;
  return times;
}

std::vector<statistics::Sample> samples_at(const std::vector<History>& histories, Quantity quantity,
                                           const std::vector<double>& times) {
  std::vector<statistics::Sample> result;
  for (const double t : times) {
    std::vector<double> values;
    for (const History& history : histories) values.push_back(history.at(quantity, t));
    result.push_back(statistics::sample_of(values));
  }
  return result;
}

}  // namespace traceraft::observations
