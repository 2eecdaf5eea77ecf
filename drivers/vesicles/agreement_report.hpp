// How far measurements agree with runs: a table for people, one for files, and what to make of it.
#pragma once

#include <string>
#include <vector>

#include "drivers/output/text_table.hpp"
#include "verification/study.hpp"
#include "verification/vesicles/comparison.hpp"

namespace traceraft {

// What the numbers are, and what they would be if nothing were wrong.
std::string about_agreement(std::size_t runs);

// A row per quantity.
std::vector<Row> agreement_rows(const std::vector<Agreement>& agreements);
Table agreement_table(const std::vector<Agreement>& agreements);

// Where there is nothing to compare, or nothing to measure deviations with.
std::vector<std::string> doubts_of(const std::vector<Agreement>& agreements);

}  // namespace traceraft
