// The numbers that a run reports, each declared once: in the tables, in summary.json or in both.
// The headings of tables, the units of the page, the tables in docs/formats.md and the layout that
// checkpoints are checked against follow from the list.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/output/text_table.hpp"
#include "drivers/run/checkpoint_store.hpp"
#include "drivers/run/run_setup.hpp"
#include "drivers/text/unit_names.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/simulation/run_monitor.hpp"

namespace traceraft::run {

// A step or an output time of a run.
struct RunMoment {
  const physics::Units& units;
  const observables::Observables& observables;
  double t;     // in the units of the outputs; at an output time, as the user wrote it
  double step;  // the one that ends there, or that the time lies in; R²/D
  time::IntegratorStatistics steps;
  linear::LinearStatistics linear;
  std::int64_t nodes;  // of the mesh; 0: there is none
};
RunMoment moment_of(const RunSetup& run, const observables::Observables& observables, double t);

// The surface that a run is on, and those who work on it.
struct RunGround {
  fem::SurfaceSpace::Totals mesh;  // zeros: there is none
  double area, h;                  // R², R; h of the smallest cells
  int ranks, threads;
  simulation::RemeshStatistics remeshing{};
};
RunGround ground_of(const RunSetup& run);

// The end of a run.
struct RunTotals {
  const RunMoment& at;
  const simulation::RunMonitor& monitor;
  RunGround ground;
  RunCost cost;
  double memory_mb;
};

// `value` is in the units of the outputs.
template <class Source>
struct ReportedNumber {
  const char* name;
  text::Unit unit;
  const char* meaning;
  double (*value)(const Source&);
};

// A raft at an output time; the largest is number 1.
struct RaftMoment {
  const observables::Raft& raft;
  int number;
  double t;  // as the user wrote it
  const physics::Units& units;
};

// A column of series.csv and observables.csv, and a number of summary.json.
const std::vector<ReportedNumber<RunMoment>>& run_columns();
// Numbers of summary.json alone.
const std::vector<ReportedNumber<RunTotals>>& run_totals();

// Columns of rafts.csv.
const std::vector<ReportedNumber<RaftMoment>>& raft_columns();

// The unit of a number of a run by its name; "" if there is none of that name.
std::string unit_of_number(const std::string& name, bool scaled);

// The heading of a table, as in "t (s),mass (um^2)", and a row of it, with line ends.
template <class Source>
std::string csv_heading(const std::vector<ReportedNumber<Source>>& columns, bool scaled) {
  std::string text;
  for (const auto& column : columns)
    text += (text.empty() ? "" : ",") + text::with_unit(column.name, column.unit, scaled);
  return text + "\n";
}
template <class Source>
std::string csv_row(const std::vector<ReportedNumber<Source>>& columns, const Source& source) {
  std::string text;
  for (const auto& column : columns)
    text += (text.empty() ? "" : ",") + format_number(column.value(source));
  return text + "\n";
}

// A checksum of the numbers that a checkpoint holds: a program that reports others cannot go on
// with it.
std::uint32_t report_layout();

// A list as a table for the docs: name, unit, meaning.
template <class Source>
std::vector<output::Row> rows_of(const std::vector<ReportedNumber<Source>>& numbers) {
  std::vector<output::Row> rows{{"name", "unit", "meaning"}};
  for (const auto& number : numbers)
    rows.push_back({number.name, text::unit_name(number.unit, false), number.meaning});
  return rows;
}

}  // namespace traceraft::run
