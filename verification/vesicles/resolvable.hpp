// Whether a light microscope could have shown what was measured.
#pragma once

#include <string>

#include "verification/vesicles/measurements.hpp"

namespace traceraft {

// Boundaries that are so long that what they enclose is narrower than the limit of diffraction,
// half a wavelength: of what has the area A and the perimeter P, round or a strip, the radius or
// width is 2 A / P. A sentence that counts such looks and names the narrowest; "" if there is none.
std::string too_long_boundaries(const MeasuredVesicles& data);

}  // namespace traceraft
