// How much an effect changes what is seen of vesicles.
#pragma once

#include <vector>

#include "verification/observations/history.hpp"
#include "verification/statistics/power_law.hpp"

namespace traceraft::selection {

// Root mean square change of the mean logarithms of all quantities at five times in the window.
// `base` and `changed`: runs of the same seeds, in the unit of the window's times.
double series_change(const std::vector<observations::History>& base,
                     const std::vector<observations::History>& changed,
                     const statistics::Window& looks);

}  // namespace traceraft::selection
