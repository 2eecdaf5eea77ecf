#include "drivers/compare/compare_report.hpp"

#include <algorithm>
#include <map>

#include "backends/posix/durable_file.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/page.hpp"
#include "drivers/text/csv.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::compare {
namespace {

using Row = std::vector<std::string>;

constexpr const char* kHeading[] = {
    "integrator",       "linear solver", "ranks",    "tolerance", "error",      "CPU s",
    "wall s (from to)", "steps",         "rejected", "failed",    "residuals",  "Jacobians",
    "set-ups",          "linear its",    "threads",  "peak MB",   "mass drift", "energy rises"};
constexpr std::size_t kNames = 4;  // columns that a failure has, too

Row cells(const bench::WorkPoint& p) {
  Row row = {p.integrator, p.linear_solver, std::to_string(p.ranks), format_number(p.tolerance)};
  if (!p.ok()) {
    row.push_back(p.failure);
    return row;
  }
  const statistics::Sample cpu = statistics::sample_of(p.cpu_s),
                           wall = statistics::sample_of(p.wall_s);
  row.push_back(formatted("%.2e", p.error));
  row.push_back(formatted("%.2f", cpu.median));
  row.push_back(formatted("%.2f", wall.median) + " (" + formatted("%.2f", wall.min) + " to " +
                formatted("%.2f", wall.max) + ")");
  for (const char* count : {"steps", "rejected", "failures", "residuals", "jacobians",
                            "linear_setups", "linear_iterations", "threads"})
    row.push_back(formatted("%.0f", p.counts.at(count)));
  row.push_back(formatted("%.0f", p.counts.at("peak_memory_mb")));
  row.push_back(formatted("%.0e", p.counts.at("mass_drift")));
  row.push_back(formatted("%.0f", p.counts.at("energy_rises")));
  return row;
}

std::vector<Row> table(const std::vector<bench::WorkPoint>& points) {
  std::vector<Row> rows = {Row(std::begin(kHeading), std::end(kHeading))};
  for (const bench::WorkPoint& p : points) rows.push_back(cells(p));
  return rows;
}

bench::Chart work_precision(const std::vector<bench::WorkPoint>& points, const char* clock,
                            std::vector<double> bench::WorkPoint::*times) {
  bench::Chart chart;
  chart.title = std::string("Error against ") + clock;
  chart.x_label = std::string(clock) + " (s, median)";
  chart.y_label = "relative error of c at the end";
  chart.log_x = chart.log_y = true;
  std::map<std::string, std::size_t> index;
  for (const bench::WorkPoint& p : points) {
    if (!p.ok() || !(p.error > 0)) continue;  // no place on a logarithmic axis
    const auto [entry, fresh] = index.emplace(p.method(), chart.series.size());
    if (fresh) chart.series.push_back({p.method(), {}});
    chart.series[entry->second].points.emplace_back(statistics::sample_of(p.*times).median,
                                                    p.error);
  }
  return chart;
}

std::string compare_csv(const std::vector<bench::WorkPoint>& points) {
  const auto with_result =
      std::find_if(points.begin(), points.end(), [](const bench::WorkPoint& p) { return p.ok(); });
  Row counts;
  if (with_result != points.end())
    for (const auto& [name, value] : with_result->counts)
      if (name != "ranks") counts.push_back(name);
  std::string csv =
      "integrator,linear_solver,ranks,tolerance,failure,error,repetitions,cpu_s,cpu_s_low,"
      "cpu_s_high,wall_s,wall_s_low,wall_s_high";
  for (const std::string& name : counts) csv += "," + name;
  csv += "\n";
  for (const bench::WorkPoint& p : points) {
    csv += p.integrator + "," + p.linear_solver + "," + std::to_string(p.ranks) + "," +
           format_number(p.tolerance) + ",";
    if (!p.ok()) {
      csv += text::csv_quoted(p.failure) + std::string(8 + counts.size(), ',') + "\n";
      continue;
    }
    csv += "," + format_number(p.error) + "," + std::to_string(p.wall_s.size());
    for (const auto& times : {p.cpu_s, p.wall_s}) {
      const statistics::Sample spread = statistics::sample_of(times);
      for (const double value : {spread.median, spread.min, spread.max})
        csv += "," + format_number(value);
    }
    for (const std::string& name : counts) csv += "," + format_number(p.counts.at(name));
    csv += "\n";
  }
  return csv;
}

}  // namespace

void print_points(const std::vector<bench::WorkPoint>& points) {
  const std::vector<Row> rows = table(points);
  std::vector<std::size_t> width(std::size(kHeading), 0);
  for (const Row& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k)
      if (row.size() == width.size()) width[k] = std::max(width[k], row[k].size());
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k)
      text::say("  %*s", static_cast<int>(row.size() == width.size() || k < kNames ? width[k] : 0),
                row[k]);
    text::say("\n");
  }
}

void write_report(const ComparisonFolder& folder, const std::vector<bench::WorkPoint>& points,
                  const bench::Recommendation& advice, const std::vector<std::string>& about) {
  posix::write_durably(folder.path() / "compare.csv", compare_csv(points));
  output::Page page("Integrators and linear solvers compared");
  page.paragraph(advice.sentence);
  for (const std::string& line : about) page.paragraph(line);
  std::string missing;
  for (const auto& [name, clock, times] :
       {std::tuple("error-wall", "wall time", &bench::WorkPoint::wall_s),
        std::tuple("error-cpu", "CPU time", &bench::WorkPoint::cpu_s)}) {
    const bench::Chart chart = work_precision(points, clock, times);
    if (chart.series.empty()) continue;
    try {
      const std::string svg = output::draw_chart(chart, folder.path() / name);
      if (svg.empty()) missing = "gnuplot is not installed (Debian package gnuplot-nox)";
      if (!svg.empty())
        page.figure(svg, "Each mark is one tolerance. Marks at the lower left are better.");
    } catch (const IoError& error) {  // the table is worth more than its picture
      missing = error.what();
    }
  }
  if (!missing.empty()) page.paragraph("Missing charts: " + missing + ".");
  page.heading("All runs");
  page.table(table(points));
  posix::write_durably(folder.path() / "compare.html", page.html());
}

}  // namespace traceraft::compare
