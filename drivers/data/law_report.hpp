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

namespace traceraft::data {

// A table's heading, and its rows: of what was fitted, if there were enough points, or published.
const output::Row& law_heading();
output::Row law_row(const std::string& of, const std::optional<observations::FittedLaw>& law);
output::Row law_row(const observations::PublishedFacts& facts);

// For readers of laws whose start may lie before all that was tried; nothing if there is none.
std::vector<std::string> remarks_on(
    std::initializer_list<std::optional<observations::FittedLaw>> laws);

// Within the window.
bench::ChartSeries law_curve(const std::string& name, const statistics::PowerLaw& law,
                             const statistics::Window& window);

}  // namespace traceraft::data
