// Charts as SVG, drawn by gnuplot.
#pragma once

#include <filesystem>
#include <string>

#include "verification/study.hpp"

namespace traceraft {

// Why there is none, for readers.
inline constexpr const char* kNoGnuplot = "gnuplot is not installed (Debian package gnuplot-nox)";

// Writes `stem`.gp, gnuplot's input with the data in it, and from it `stem`.svg, whose text is
// returned. "" if gnuplot is not installed; throws IoError if it fails.
std::string draw_chart(const Chart& chart, const std::filesystem::path& stem);

}  // namespace traceraft
