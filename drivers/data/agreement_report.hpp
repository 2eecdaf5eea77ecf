// How far measurements agree with runs: a table for people, one for files, and what to make of it.
#pragma once

#include <string>
#include <vector>

#include "drivers/output/text_table.hpp"
#include "verification/bench/figures.hpp"
#include "verification/observations/comparison.hpp"

namespace traceraft::data {

// An explanation of the numbers, and of what they would be if nothing were wrong.
std::string about_agreement(std::size_t runs);

// A row per quantity.
std::vector<output::Row> agreement_rows(const std::vector<observations::Agreement>& agreements);
bench::Table agreement_table(const std::vector<observations::Agreement>& agreements);

// A sentence on an onset that would remove a trend; "" if there is no trend, or none would.
std::string onset_note(const observations::MeasuredVesicles& data,
                       const std::vector<observations::History>& runs);

// Why the two may differ although the model is right, or cannot be compared: vesicles of another
// size or raft fraction than the simulated one (`radius`, µm), perimeters that light does not show,
// nothing to compare or to measure deviations with.
std::vector<std::string> cautions(const observations::MeasuredVesicles& data, double radius,
                                  const std::vector<observations::History>& runs,
                                  const std::vector<observations::Agreement>& agreements);

}  // namespace traceraft::data
