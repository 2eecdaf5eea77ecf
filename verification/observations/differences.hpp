// In what measured vesicles differ from the one that is simulated, more than one model can stand
// for.
#pragma once

#include <string>
#include <vector>

#include "verification/observations/measurements.hpp"

namespace traceraft::observations {

struct SimulatedVesicle {
  double radius;         // µm
  double raft_fraction;  // of the area, as it is measured
};

// The simulated vesicle, with the mean raft fraction at the times at which that of vesicles was
// measured. Times of the runs are those of the data.
SimulatedVesicle simulated_vesicle(double radius, const std::vector<History>& runs,
                                   const MeasuredVesicles& data);

// By how much D would be larger if the vesicles that have shown rafts, rather than the simulated
// one, were simulated: boundaries of rafts move by diffusion along them, over times that go with R⁴
// (Cahn, Elliott and Novick-Cohen 1996; runs of 5 and 6.6 µm agree with that, docs/results.md).
double factor_of_size(const MeasuredVesicles& data, double radius);
// A sentence on that. It ends on the --radius to simulate with.
std::string effect_of_size(const MeasuredVesicles& data, double radius);

// Sentences: radii that are further from the simulated one than by a fifth, since at the same time
// a larger vesicle has more rafts and a longer perimeter over radius; a mean raft fraction that is
// more than two standard deviations between vesicles, and a tenth, off.
std::vector<std::string> differences(const MeasuredVesicles& data, const SimulatedVesicle& model);

}  // namespace traceraft::observations
