// Charts as SVG, drawn by gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace traceraft {

struct ChartSeries {
  std::string name;
  std::vector<std::pair<double, double>> points;
};

struct Chart {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<ChartSeries> series;
};

// Writes `stem`.gp, gnuplot's input with the data in it, and from it `stem`.svg, whose text is
// returned. "" if gnuplot is not installed; throws IoError if it fails.
std::string draw_chart(const Chart& chart, const std::filesystem::path& stem);

}  // namespace traceraft
