// The facts that a paper prints of its measurements, where the measurements themselves are not
// public.
#pragma once

#include <cstdint>
#include <string>

#include "verification/observations/measurements.hpp"
#include "verification/observations/perimeter_law.hpp"

namespace traceraft::observations {

struct PublishedFacts {
  std::string name, origin, composition;
  double celsius;
  int vesicles, measurements;
  double fraction, fraction_sd;    // raft area fraction, mean and standard deviation
  double radius_min, radius_max;   // µm
  statistics::PowerLaw perimeter;  // over radius; the scatter is an assumption
  statistics::Window window;       // s, of the law
  int outliers;                    // measurements outside the range of the published simulations
};

// Vesicles that could have been measured: as many as published, radii evenly spread, times evenly
// spread in ln t over the window, perimeters and fractions with the given mean and scatter, half of
// its variance the vesicle's own and half added by each look; the number of rafts is that of equal
// caps with the vesicle's own perimeter and fraction, rounded, at least 1. Uncertainties: what
// looks add to perimeters, and all of the scatter of fractions, as simulated vesicles do not differ
// in composition. Marked as synthetic.
MeasuredVesicles draw_measurements(const PublishedFacts& facts, std::uint64_t seed);

// The same looks at simulated vesicles, one run each: perimeters scatter as published, fractions
// with half of the published variance (runs have none), which are their uncertainties; numbers of
// rafts and radii (`radius`, in µm) are exact. As many vesicles as there are runs, at most; the
// runs have to cover the window. Throws InputError if they do not, or if there is none.
MeasuredVesicles draw_from_runs(const PublishedFacts& facts, const std::vector<History>& runs,
                                double radius, std::uint64_t seed);

}  // namespace traceraft::observations
