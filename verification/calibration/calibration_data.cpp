#include "verification/calibration/calibration_data.hpp"

#include <algorithm>
#include <string>

#include "kernel/core/error.hpp"

namespace traceraft::calibration {
namespace {

constexpr std::size_t kLeastVesicles = 3;  // to know how they scatter

bool tells(const observations::Measurement& m) {
  return m.time > 0 && m.shows_rafts();
}

}  // namespace

std::vector<int> telling_vesicles(const observations::MeasuredVesicles& data) {
  if (!(observations::looks(data).end > 0))
    throw InputError("a calibration needs observations after time zero");
  std::vector<int> result;
  const auto vesicles = data.vesicles();
  for (std::size_t k = 0; k < vesicles.size(); ++k) {
    const auto begin = data.measurements.begin();
    if (std::any_of(begin + static_cast<std::ptrdiff_t>(vesicles[k].first),
                    begin + static_cast<std::ptrdiff_t>(vesicles[k].second), tells))
      result.push_back(static_cast<int>(k));
  }
  if (result.size() < kLeastVesicles)
    throw InputError(
        "a calibration needs at least three vesicles with rafts, whose perimeters or numbers of "
        "rafts were measured after time zero; there are " +
        std::to_string(result.size()));
  return result;
}

int looks_that_tell_nothing(const observations::MeasuredVesicles& data) {
  return static_cast<int>(
      std::count_if(data.measurements.begin(), data.measurements.end(),
                    [](const observations::Measurement& m) { return !tells(m); }));
}

}  // namespace traceraft::calibration
