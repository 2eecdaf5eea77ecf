// Tables from CSV files (RFC 4180, by libcsv), with the places of their cells for complaints.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace traceraft::input {

class CsvTable {
 public:
  // The first row names the columns. A unit in parentheses after a name is no part of it. Lines
  // that are empty or start with # do not count. Throws IoError if the file cannot be read,
  // DamagedFile if it ends with a checksum that is not its own, InputError naming the line if it is
  // no such table: no heading, two columns of one name, a row with more or fewer cells, a quote
  // that does not end.
  static CsvTable read(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  std::size_t rows() const { return cells_.size(); }
  const std::vector<std::string>& columns() const { return columns_; }
  bool has(const std::string& column) const { return index(column).has_value(); }
  // Throws InputError if there is no such column.
  void require(const std::string& column) const;

  // Throw InputError as require; `number` also unless the cell holds a finite number.
  const std::string& text(std::size_t row, const std::string& column) const;
  double number(std::size_t row, const std::string& column) const;
  std::vector<double> numbers(const std::string& column) const;
  bool empty(std::size_t row, const std::string& column) const { return text(row, column).empty(); }

  // "data.csv:3: column 'time'": starts every complaint about a cell.
  std::string where(std::size_t row, const std::string& column) const;
  std::string where(std::size_t row) const;  // "data.csv:3"
  std::string heading() const;               // the same of the heading

 private:
  std::optional<std::size_t> index(const std::string& column) const;

  std::filesystem::path path_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> cells_;
  std::vector<long> lines_;
  long heading_line_ = 1;
};

}  // namespace traceraft::input
