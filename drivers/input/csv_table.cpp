#include "drivers/input/csv_table.hpp"

#include <csv.h>

#include <algorithm>
#include <cmath>

#include "backends/posix/durable_file.hpp"
#include "drivers/text/csv.hpp"
#include "drivers/text/unit_names.hpp"
#include "drivers/text/utf8.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::input {
namespace {

constexpr std::uint64_t kLargestTable = std::uint64_t{1} << 30;

struct Rows {
  std::vector<std::string> row;
  std::vector<std::vector<std::string>> rows;
  std::vector<long> lines;
  long line = 0;  // that is being read
};

void take_cell(void* cell, std::size_t size, void* target) {
  static_cast<Rows*>(target)->row.emplace_back(static_cast<const char*>(cell), size);
}

// Rows without a value, which spreadsheets leave at the end, are none.
void take_row(int, void* target) {
  Rows& rows = *static_cast<Rows*>(target);
  if (std::any_of(rows.row.begin(), rows.row.end(),
                  [](const std::string& cell) { return !cell.empty(); })) {
    rows.rows.push_back(std::move(rows.row));
    rows.lines.push_back(rows.line);
  }
  rows.row.clear();
}

class Parser {
 public:
  Parser() {
    if (csv_init(&parser_, CSV_STRICT | CSV_STRICT_FINI) != 0) throw std::bad_alloc();
  }
  ~Parser() { csv_free(&parser_); }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;

  bool feed(const std::string& text, Rows& rows) {
    return csv_parse(&parser_, text.data(), text.size(), take_cell, take_row, &rows) == text.size();
  }
  bool finish(Rows& rows) { return csv_fini(&parser_, take_cell, take_row, &rows) == 0; }

 private:
  csv_parser parser_;
};

// A row whose first cell begins with # would be lost without a word.
void refuse_row_as_remark(const std::filesystem::path& path, const Rows& rows,
                          const std::string& remark) {
  if (rows.rows.empty()) return;
  const auto columns = static_cast<std::ptrdiff_t>(rows.rows.front().size());
  if (columns > 1 && std::count(remark.begin(), remark.end(), ',') == columns - 1)
    throw InputError(path.string() + ":" + std::to_string(rows.line) +
                     ": this comment has as many commas as a row; names cannot begin with #, and a "
                     "row to leave out must be deleted");
}

// Refuses tables as spreadsheets of many countries write them, with commas within numbers.
void refuse_other_separators(const std::string& where, const std::vector<std::string>& columns) {
  if (columns.size() != 1) return;
  for (const auto& [separator, name] : {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}})
    if (columns.front().find(separator) != std::string::npos)
      throw InputError(where + ": columns are separated by " + name +
                       "; commas are needed (and points in numbers)");
}

// Line by line, so that every row knows where it stands.
Rows parse(const std::filesystem::path& path, std::string text) {
  if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.erase(0, 3);  // as spreadsheets begin
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
  Rows rows;
  Parser parser;
  const auto refuse = [&] {
    throw InputError(path.string() + ":" + std::to_string(rows.line) +
                     ": this is not CSV (a quote within a cell, or a quote that does not end)");
  };
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    ++rows.line;
    const std::string line = text.substr(begin, end - begin);
    if (!text::is_utf8(line))
      throw InputError(path.string() + ":" + std::to_string(rows.line) +
                       ": this is not UTF-8; save the table as CSV in UTF-8");
    if (line[0] == '#')
      refuse_row_as_remark(path, rows, line);
    else if (!parser.feed(line, rows))
      refuse();
    begin = end;
  }
  if (!parser.finish(rows)) refuse();
  return rows;
}

// Tables that the program itself has written may end with one.
void require_checksum(const std::filesystem::path& path, const std::string& text) {
  const std::size_t at = text.rfind(text::kChecksumRemark);
  if (at == std::string::npos) return;
  if (text.substr(at) != text::checksum_line(text.substr(0, at)))
    throw DamagedFile(path.string() + " is damaged: its rows have changed");
}

}  // namespace

CsvTable CsvTable::read(const std::filesystem::path& path) {
  std::string text = posix::read_file(path, kLargestTable);
  require_checksum(path, text);
  if (text.find('\0') != std::string::npos)
    throw InputError(path.string() +
                     " is not plain text, or is in UTF-16; save the table as CSV in UTF-8");
  Rows rows = parse(path, std::move(text));
  CsvTable table;
  table.path_ = path;
  if (rows.rows.empty()) throw InputError(path.string() + ": the file is empty");
  table.columns_ = std::move(rows.rows.front());
  for (std::string& column : table.columns_) column = text::without_unit(column);
  table.heading_line_ = rows.lines.front();
  refuse_other_separators(table.heading(), table.columns_);
  for (std::size_t i = 0; i < table.columns_.size(); ++i)
    if (table.index(table.columns_[i]) != i)
      throw InputError(table.heading() + ": two columns are called '" + table.columns_[i] + "'");
  table.cells_.assign(std::make_move_iterator(rows.rows.begin() + 1),
                      std::make_move_iterator(rows.rows.end()));
  table.lines_.assign(rows.lines.begin() + 1, rows.lines.end());
  for (std::size_t i = 0; i < table.rows(); ++i)
    if (table.cells_[i].size() != table.columns_.size())
      throw InputError(table.where(i) + ": " + std::to_string(table.cells_[i].size()) +
                       " cells, but there are " + std::to_string(table.columns_.size()) +
                       " columns" +
                       (table.cells_[i].size() > table.columns_.size()
                            ? " (do numbers have commas instead of points?)"
                            : ""));
  return table;
}

std::optional<std::size_t> CsvTable::index(const std::string& column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns_.begin());
}

void CsvTable::require(const std::string& column) const {
  if (!has(column))
    throw InputError(heading() + ": there is no column '" + column +
                     "' (there are: " + joined(columns_, ", ") + ")");
}

const std::string& CsvTable::text(std::size_t row, const std::string& column) const {
  const auto at = index(column);
  if (!at) require(column);  // which throws
  return cells_[row][*at];
}

double CsvTable::number(std::size_t row, const std::string& column) const {
  return parse_number(where(row, column), text(row, column));
}

std::vector<double> CsvTable::numbers(const std::string& column) const {
  require(column);  // of a table without rows, too
  std::vector<double> values;
  for (std::size_t row = 0; row < rows(); ++row) values.push_back(number(row, column));
  return values;
}

std::string CsvTable::heading() const {
  return path_.string() + ":" + std::to_string(heading_line_);
}

std::string CsvTable::where(std::size_t row) const {
  return path_.string() + ":" + std::to_string(lines_[row]);
}

std::string CsvTable::where(std::size_t row, const std::string& column) const {
  return where(row) + ": column '" + column + "'";
}

}  // namespace traceraft::input
