// Whether a light microscope could have shown what was measured.
#pragma once

#include <string>

#include "verification/vesicles/measurements.hpp"

namespace traceraft {

// Boundaries that are so long that what they enclose is smaller than the limit of diffraction, half
// a wavelength: equal discs with the area A and the perimeter P together have the diameter 4 A / P.
// A sentence that counts such looks and names the worst; "" if there is none.
std::string too_long_boundaries(const MeasuredVesicles& data);

}  // namespace traceraft
