// Tables of what `explain` has found, for the terminal and the page. The first row is the heading.
#pragma once

#include <vector>

#include "drivers/explain/explain_run.hpp"
#include "drivers/explain/found_parameters.hpp"
#include "drivers/output/text_table.hpp"

namespace traceraft::explain {

std::vector<output::Row> parameter_rows(const selection::Explanation& found,
                                        const physics::Units& base);
std::vector<output::Row> bound_rows(const selection::Explanation& found,
                                    const physics::Units& base);
std::vector<output::Row> gap_rows(const selection::Explanation& found);
std::vector<output::Row> score_rows(const selection::Round& round);  // and refits
std::vector<output::Row> disagreement_rows(const selection::Explanation& found,
                                           const ExplainSetup& setup, std::size_t most);

}  // namespace traceraft::explain
