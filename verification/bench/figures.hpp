// Tables and charts of what was measured.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "verification/statistics/power_law.hpp"

namespace traceraft::bench {

struct Cell {
  bool is_number;
  double number = 0;
  std::string text = {};

  Cell(double value) : is_number(true), number(value) {}                 // NOLINT: cells of
  Cell(std::string value) : is_number(false), text(std::move(value)) {}  // NOLINT: a table
  Cell(const char* value) : Cell(std::string(value)) {}                  // NOLINT: mix both
};
struct Table {
  std::string name;  // unique within its study; part of a file name
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;
};

// band: between the points and `other`, as many values of y; bars: `other` is the half length of
// error bars.
enum class Mark { line, points, both, band, bars };
struct ChartSeries {
  std::string name;
  statistics::Points points;
  Mark mark = Mark::both;
  std::vector<double> other = {};
};
struct Chart {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<ChartSeries> series;
};

}  // namespace traceraft::bench
