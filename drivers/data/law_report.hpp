// Power laws of the perimeter, for people.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "drivers/output/chart.hpp"
#include "drivers/output/text_table.hpp"
#include "verification/observations/perimeter_law.hpp"
#include "verification/observations/published.hpp"

namespace traceraft {

// A table's heading, and its rows: of what was fitted, if there were enough points, or published.
const Row& law_heading();
Row law_row(const std::string& of, const std::optional<FittedLaw>& law);
Row law_row(const PublishedFacts& facts);

// For readers of laws whose start may lie before all that was tried; nothing if there is none.
std::vector<std::string> remarks_on(std::initializer_list<std::optional<FittedLaw>> laws);

// Within the window.
ChartSeries law_curve(const std::string& name, const PowerLaw& law, const Window& window);

}  // namespace traceraft
