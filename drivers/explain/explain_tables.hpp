// Tables of what `explain` has found, for the terminal and the page. The first row is the heading.
#pragma once

#include <vector>

#include "drivers/explain/explain_run.hpp"
#include "drivers/explain/found_parameters.hpp"
#include "drivers/output/text_table.hpp"

namespace traceraft {

std::vector<Row> parameter_rows(const Explanation& found, const Units& base);
std::vector<Row> bound_rows(const Explanation& found, const Units& base);
std::vector<Row> gap_rows(const Explanation& found);
std::vector<Row> score_rows(const Round& round);  // and refits
std::vector<Row> disagreement_rows(const Explanation& found, const ExplainSetup& setup,
                                   std::size_t most);

}  // namespace traceraft
