// Tables as text: for terminals, CSV files and Markdown.
#pragma once

#include <string>
#include <vector>

#include "verification/measure/figures.hpp"

namespace traceraft {

using Row = std::vector<std::string>;

std::string short_number(double value);           // five digits
std::vector<Row> table_rows(const Table& table);  // the heading first, numbers short

void print_rows(const std::vector<Row>& rows);  // in columns, the first one flush left
std::string csv_text(const Table& table);       // numbers in full precision
std::string markdown_table(const std::vector<Row>& rows);

}  // namespace traceraft
