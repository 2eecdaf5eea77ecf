// Charts as SVG, drawn by gnuplot.
#pragma once

#include <filesystem>
#include <string>

#include "drivers/output/page.hpp"
#include "verification/bench/figures.hpp"

namespace traceraft::output {

// Why there is none, for readers.
inline constexpr const char* kNoGnuplot = "gnuplot is not installed (Debian package gnuplot-nox)";

// Writes `stem`.gp, gnuplot's input with the data in it, and from it `stem`.svg, whose text is
// returned. "" if gnuplot is not installed; throws IoError if it fails. The last part of `stem`
// consists of letters, digits, - and _; std::logic_error for others.
std::string draw_chart(const bench::Chart& chart, const std::filesystem::path& stem);

// The things that a page lacks, collected.
class Missing {
 public:
  void add(const std::string& what) {
    if (!what.empty() && text_.find(what) == std::string::npos)
      text_ += (text_.empty() ? "" : "; ") + what;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// Draws, and shows it on the page, or notes that it is missing.
void add_chart(Page& page, const bench::Chart& chart, const std::filesystem::path& stem,
               Missing& missing);

}  // namespace traceraft::output
