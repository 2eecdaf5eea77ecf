// Tables as text: for terminals, CSV files and Markdown.
#pragma once

#include <string>
#include <vector>

#include "verification/bench/figures.hpp"

namespace traceraft::output {

using Row = std::vector<std::string>;

std::string short_number(double value);                  // five digits
std::vector<Row> table_rows(const bench::Table& table);  // the heading first, numbers short

void print_rows(const std::vector<Row>& rows);    // in columns, the first one flush left
std::string csv_text(const bench::Table& table);  // numbers in full precision
// The same with a last line that CsvTable::read checks it by: for tables that are read again.
std::string checked_csv_text(const bench::Table& table);
// to_headings: cells of the first column, but for the first, are links to headings of that text.
enum class MarkdownLinks { none, to_headings };
std::string markdown_table(const std::vector<Row>& rows, MarkdownLinks links = MarkdownLinks::none);

}  // namespace traceraft::output
