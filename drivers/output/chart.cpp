#include "drivers/output/chart.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "backends/posix/child.hpp"
#include "backends/posix/durable_file.hpp"
#include "backends/posix/own_files.hpp"
#include "drivers/text/encoders.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::output {
namespace {

const char* style(bench::Mark mark) {
  switch (mark) {
    case bench::Mark::line:
      return "lines";
    case bench::Mark::points:
      return "points pt 7 ps 0.7";
    case bench::Mark::band:
      return "filledcurves fillstyle transparent solid 0.25 noborder";
    case bench::Mark::bars:
      return "yerrorbars pt 7 ps 0.7 lw 1";
    default:
      return "linespoints pt 7 ps 0.7";
  }
}

// Told apart by people who see few colours, too (Okabe and Ito).
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                    "#e69f00", "#000000", "#56b4e9", "#999999"};

// Logarithms have no place for what is not positive. Bands end at the axis then.
bool drawable(const bench::Chart& chart, const bench::ChartSeries& series, std::size_t k) {
  const auto& [x, y] = series.points[k];
  const bool band = series.mark == bench::Mark::band;
  const double highest = band ? std::max(y, series.other[k]) : y;
  return std::isfinite(x) && std::isfinite(y) && (x > 0 || !chart.log_x) &&
         (highest > 0 || !chart.log_y) && (!band || std::isfinite(series.other[k]));
}

bool has_something(const bench::Chart& chart, const bench::ChartSeries& series) {
  for (std::size_t k = 0; k < series.points.size(); ++k)
    if (drawable(chart, series, k)) return true;
  return false;
}

struct Extent {
  double least = HUGE_VAL, most = -HUGE_VAL;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

// The extents of what is drawn, and along x of all there is: what has fallen to 0 leaves a
// logarithmic chart empty.
struct Extents {
  Extent x, y, all_x;
};

Extents extents(const bench::Chart& chart) {
  Extents result;
  const auto add = [&](double y) {
    if (y > 0 || !chart.log_y) result.y.add(y);
  };
  for (const bench::ChartSeries& series : chart.series)
    for (std::size_t k = 0; k < series.points.size(); ++k) {
      const auto& [x, y] = series.points[k];
      if (std::isfinite(x) && (x > 0 || !chart.log_x)) result.all_x.add(x);
      if (!drawable(chart, series, k)) continue;
      result.x.add(x);
      add(y);
      if (series.mark == bench::Mark::band) add(series.other[k]);
      if (series.mark == bench::Mark::bars) add(y + series.other[k]);
    }
  return result;
}

// The largest of 1, 2 and 5 times a power of ten that is no larger.
double nice_step(double largest) {
  const double decade = std::pow(10, std::floor(std::log10(largest)));
  return decade * (5 * decade <= largest ? 5 : 2 * decade <= largest ? 2 : 1);
}

// Labelled tics of a logarithmic axis that decades alone do not fill: a few, evenly spaced, on a
// short one; at every digit; at 1, 2 and 5 of a decade, with short tics at the others.
std::string log_tics(const Extent& extent) {
  constexpr double kOne = 1.01, kShort = 2.5, kDecade = 10;
  const double ratio = extent.most / extent.least;
  if (!(ratio > kOne)) return formatted("%.6g", extent.least);
  std::string tics;
  const auto add = [&](double at, bool labelled) {
    tics += (tics.empty() ? "" : ", ") + std::string(labelled ? "" : "'' ") +
            formatted("%.6g", at) + (labelled ? "" : " 1");
  };
  if (ratio < kShort) {
    const double step = nice_step((extent.most - extent.least) / 3);
    const int first = std::max(1, static_cast<int>(std::floor(extent.least / step)));
    for (int k = first; k <= static_cast<int>(std::ceil(extent.most / step)); ++k)
      add(k * step, true);
    return tics;
  }
  for (double decade = std::pow(10, std::floor(std::log10(extent.least) - 1));
       decade <= 10 * extent.most; decade *= 10)
    for (int digit = 1; digit <= 9; ++digit) {
      add(digit * decade, ratio < kDecade || digit == 1 || digit == 2 || digit == 5);
      if (ratio < kDecade && digit == 1) add(1.5 * decade, true);
    }
  return tics;
}

std::string log_axis(const std::string& axis, const Extent& extent) {
  constexpr double kManyDecades = 1e3, kPlain = 1e5;
  std::string text = "set logscale " + axis + "\n";
  const bool plain = extent.most < kPlain && extent.least > 1 / kPlain;
  text += "set format " + axis + (plain ? " '%g'\n" : " '%.0e'\n");
  if (extent.most > kManyDecades * extent.least) return text;
  return text + "set " + axis + "tics (" + log_tics(extent) + ")\n";
}

// The one name of a chart's files; anything else could be a command of a shell or of gnuplot.
std::string plain_name(const std::filesystem::path& stem) {
  const std::string name = stem.filename().string();
  const char* allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  constexpr std::size_t kLongestName = 100;
  if (name.empty() || name.size() > kLongestName || name[0] == '-' ||
      name.find_first_not_of(allowed) != std::string::npos)
    throw std::logic_error("'" + name.substr(0, kLongestName) +
                           "' cannot name the files of a chart");
  return name;
}

// Text stands within single quotes, where gnuplot knows no commands, no macros and no pipes.
void refuse_commands(const std::string& script) {
  bool quoted = false;
  for (const char ch : script) {
    if (ch == '\'') quoted = !quoted;
    if (quoted ? ch == '\n' : std::string("`@|!\"\\;").find(ch) != std::string::npos)
      throw std::logic_error("the input of gnuplot would hold a command");
  }
}

std::string script(const bench::Chart& chart, const std::string& svg) {
  std::string text = "set terminal svg noenhanced size 720,520 dynamic font 'sans-serif,13'\n";
  text += "set output " + text::in_gnuplot(svg) + "\n";
  text += "set title " + text::in_gnuplot(chart.title) + "\n";
  text += "set xlabel " + text::in_gnuplot(chart.x_label) + "\nset ylabel " +
          text::in_gnuplot(chart.y_label) + "\n";
  const auto [x, y, all_x] = extents(chart);
  if (chart.log_x) text += log_axis("x", all_x);
  if (all_x.least < x.least || all_x.most > x.most)
    text += "set xrange [" + format_number(all_x.least) + ":" + format_number(all_x.most) + "]\n";
  double lowest = -HUGE_VAL;
  if (chart.log_y) {
    // A curve that is 1 all the time does not lie on the axis then.
    constexpr double kMargin = 1.18;
    const Extent shown{y.least / kMargin, y.most * kMargin};
    lowest = shown.least;
    text += log_axis("y", shown) + "set yrange [" + format_number(shown.least) + ":" +
            format_number(shown.most) + "]\n";
  }
  text += "set key outside below\nset grid lc rgb '#dddddd'\n";
  for (std::size_t i = 0; i < std::size(kColours); ++i)
    text += "set linetype " + std::to_string(i + 1) + " lw 2 lc rgb '" + kColours[i] + "'\n";
  std::string plots;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const bench::ChartSeries& series = chart.series[i];
    if (!has_something(chart, series)) continue;
    const std::string block = "$s" + std::to_string(i);
    text += block + " << END\n";
    for (std::size_t k = 0; k < series.points.size(); ++k) {
      if (!drawable(chart, series, k)) continue;
      text += format_number(series.points[k].first) + " " +
              format_number(std::max(series.points[k].second, lowest));
      if (!series.other.empty())
        text +=
            " " + format_number(series.mark == bench::Mark::band ? std::max(series.other[k], lowest)
                                                                 : series.other[k]);
      text += "\n";
    }
    text += "END\n";
    plots += (plots.empty() ? "" : ", ") + block + " with " + style(series.mark) + " title " +
             text::in_gnuplot(series.name);
  }
  return text + "plot " + plots + "\n";
}

}  // namespace

std::string draw_chart(const bench::Chart& chart, const std::filesystem::path& stem) {
  const auto with = [&](const char* extension) {
    std::filesystem::path path = stem;
    return path += extension;
  };
  if (std::none_of(chart.series.begin(), chart.series.end(),
                   [&](const bench::ChartSeries& series) { return has_something(chart, series); }))
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"720\" height=\"40\"><text y=\"24\">"
           "nothing to show</text></svg>";
  // In the folder of its files, with names that are plain, and without the user's start-up files.
  const std::string name = plain_name(stem), input = script(chart, name + ".svg");
  refuse_commands(input);
  posix::write_durably(with(".gp"), input);
  posix::remove_file(with(".svg"));  // gnuplot would write through a link
  posix::ChildRequest request{{"gnuplot", "--default-settings", name + ".gp"}, with(".log"), 60};
  request.folder = stem.parent_path();
  const posix::ChildResult result = posix::run_child(request);
  if (result.exit_code == 127) return "";
  if (result.exit_code != 0)
    throw IoError("gnuplot failed on " + with(".gp").string() + "; see " + with(".log").string());
  std::string svg = posix::read_file(with(".svg"), 1 << 24);
  const std::size_t begin = svg.find("<svg");  // without the XML header: goes into pages
  if (begin == std::string::npos)
    throw IoError(with(".svg").string() + " is not a picture; another process may be writing it");
  return svg.substr(begin);
}

void add_chart(Page& page, const bench::Chart& chart, const std::filesystem::path& stem,
               Missing& missing) {
  const std::string svg = draw_chart(chart, stem);
  if (svg.empty())
    missing.add(kNoGnuplot);
  else
    page.figure(svg, chart.title);
}

}  // namespace traceraft::output
