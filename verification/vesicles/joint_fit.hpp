// The parameters under which measurements are most probable: the unit of time, the scatter of
// measuring, and those that cost simulations, all at once.
#pragma once

#include <optional>
#include <vector>

#include "verification/vesicles/run_emulator.hpp"

namespace traceraft {

// Where parameters are looked for.
struct Box {
  std::vector<double> lower, upper;
};

// Mean raft fractions of vesicles, which scatter from vesicle to vesicle. As fractions of runs grow
// in time, they are held against those at the very times.
class MeasuredFractions {
 public:
  explicit MeasuredFractions(const MeasuredVesicles& data);
  // −2 ln of the likelihood of those of `sample`, if runs of that unit of time tell the truth.
  double deviance(const std::vector<int>& sample, const RunStatistics& runs,
                  double seconds_per_unit) const;

 private:
  std::vector<std::optional<FractionOfVesicle>> vesicles_;
  double variance_ = 0;  // 0: of a single vesicle nobody knows how they scatter
};

// Everything that counts, of the vesicles of `sample`: `fractions` only where that of rafts is
// looked for.
struct Evidence {
  const MeasuredVesicles& data;
  const std::vector<int>& sample;
  const MeasuredFractions* fractions;
  const TimeUnit& unit;

  // Of runs, the unit of time and the scatter that make the data most probable.
  TimeFit fit(const RunStatistics& runs) const;
  TimeFit fit(const RunStatistics& runs, const TimeFit& near) const;
};

struct JointFit {
  std::vector<double> ln_parameters;
  TimeFit time;
};

// The best one that is found from the starts.
JointFit fit_jointly(const Evidence& evidence, const RunEmulator& runs, const Box& box,
                     const std::vector<JointFit>& starts);

}  // namespace traceraft
