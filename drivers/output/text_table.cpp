#include "drivers/output/text_table.hpp"

#include <algorithm>

#include "drivers/text/csv.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::output {

std::string short_number(double value) {
  return formatted("%.5g", value);
}

std::vector<Row> table_rows(const bench::Table& table) {
  std::vector<Row> rows = {table.columns};
  for (const auto& cells : table.rows) {
    Row row;
    for (const bench::Cell& cell : cells)
      row.push_back(cell.is_number ? short_number(cell.number) : cell.text);
    rows.push_back(row);
  }
  return rows;
}

void print_rows(const std::vector<Row>& rows) {
  std::vector<std::size_t> width(rows.front().size(), 0);
  for (const Row& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k) width[k] = std::max(width[k], row[k].size());
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) {
      const std::string gap(width[k] - row[k].size(), ' ');
      // The first column is a name as a rule.
      line += "  " + (k == 0 ? row[k] + gap : gap + row[k]);
    }
    text::say("%s\n", line);
  }
}

std::string csv_text(const bench::Table& table) {
  std::string csv;
  const auto line = [&csv](const auto& cells, const auto& text) {
    for (std::size_t k = 0; k < cells.size(); ++k) csv += (k == 0 ? "" : ",") + text(cells[k]);
    csv += "\n";
  };
  line(table.columns, text::csv_cell);
  for (const auto& row : table.rows)
    line(row, [&](const bench::Cell& cell) {
      return cell.is_number ? format_number(cell.number) : text::csv_cell(cell.text);
    });
  return csv;
}

std::string checked_csv_text(const bench::Table& table) {
  const std::string csv = csv_text(table);
  return csv + text::checksum_line(csv);
}

std::string markdown_table(const std::vector<Row>& rows, MarkdownLinks links) {
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    text += "|";
    for (std::size_t k = 0; k < rows[r].size(); ++k) {
      const std::string cell = text::in_markdown(rows[r][k]);
      const bool link = links == MarkdownLinks::to_headings && r > 0 && k == 0;
      text += " " + (link ? "[" + cell + "](#" + text::in_markdown_link(rows[r][k]) + ")" : cell) +
              " |";
    }
    text += "\n";
    if (r > 0) continue;
    text += "|";
    for (std::size_t k = 0; k < rows[r].size(); ++k) text += "---|";
    text += "\n";
  }
  return text + "\n";
}

}  // namespace traceraft::output
