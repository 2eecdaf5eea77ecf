// Whether there could be, and a light microscope could show, what was measured.
#pragma once

#include <string>
#include <vector>

#include "verification/observations/measurements.hpp"

namespace traceraft::observations {

// Boundaries so long, or rafts so many, that they are smaller than the limit of diffraction, half a
// wavelength: N equal discs with the area A and the perimeter P together have the diameter 4 A / P,
// or √(4 A / π N). A sentence that counts such looks and names the worst; "" if there is none.
std::string too_long_boundaries(const MeasuredVesicles& data);

// The same of perimeters that are shorter, by more than a tenth and errors of measuring, than that
// of a single cap, which no boundary around as large a raft fraction can be.
std::string too_short_boundaries(const MeasuredVesicles& data);

// Looks beyond a day, or all of them within a second: most likely the unit of time is another one.
// "" if there are none.
std::string unusual_times(const MeasuredVesicles& data);

// All of these that there are.
std::vector<std::string> doubts_about(const MeasuredVesicles& data);

}  // namespace traceraft::observations
