#include "drivers/ensemble/ensemble_report.hpp"

#include "backends/posix/durable_file.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/provenance.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft {
namespace {

constexpr int kPerDecade = 24;

struct Statistic {
  const char* name;
  double Sample::*value;
};
constexpr Statistic kStatistics[] = {
    {"mean", &Sample::mean}, {"sd", &Sample::deviation}, {"min", &Sample::min},
    {"q10", &Sample::q10},   {"q25", &Sample::q25},      {"median", &Sample::median},
    {"q75", &Sample::q75},   {"q90", &Sample::q90},      {"max", &Sample::max}};

ChartSeries band(const EnsembleSummary& summary, Quantity quantity, const char* name,
                 double Sample::*low, double Sample::*high) {
  ChartSeries series{name, {}, Mark::band};
  const auto& at = summary.at[index_of(quantity)];
  for (std::size_t i = 0; i < at.size(); ++i) {
    series.points.emplace_back(summary.times[i], at[i].*low);
    series.other.push_back(at[i].*high);
  }
  return series;
}

std::string sentence_on(const Configuration& configuration, const EnsemblePlan& plan,
                        std::size_t finished) {
  return std::to_string(finished) + " of " + std::to_string(plan.runs) + " runs of the case " +
         configuration.options().case_name + ", seeds " + std::to_string(plan.first_seed) + " to " +
         std::to_string(plan.last_seed()) + ": raft fraction " +
         format_number(configuration.options().raft_fraction) + ", epsilon " +
         format_number(configuration.options().epsilon) + ", " +
         std::to_string(configuration.options().cells) +
         " cells. Perimeters are diffuse perimeters, divided by the radius.";
}

}  // namespace

std::vector<Row> ensemble_rows(const EnsembleSummary& summary, bool seconds) {
  std::vector<Row> rows = {{seconds ? "time (s)" : "time"}};
  for (const Quantity quantity : kQuantities)
    rows.front().push_back(std::string(name_of(quantity).label) + ", median (range)");
  for (std::size_t i = 0; i < summary.times.size(); ++i) {
    if (i % kPerDecade != 0 && i + 1 != summary.times.size()) continue;
    Row row = {short_number(summary.times[i])};
    for (const auto& at : summary.at)
      row.push_back(short_number(at[i].median) + " (" + short_number(at[i].min) + " to " +
                    short_number(at[i].max) + ")");
    rows.push_back(row);
  }
  return rows;
}

EnsembleSummary summarise(const std::vector<History>& runs) {
  EnsembleSummary summary{runs.size(), {}, {}};
  summary.times = common_times(runs, kPerDecade);
  if (summary.times.empty()) throw InputError("the runs of the ensemble have no times in common");
  for (const Quantity quantity : kQuantities)
    summary.at[index_of(quantity)] = samples_at(runs, quantity, summary.times);
  return summary;
}

Table ensemble_table(const EnsembleSummary& summary) {
  Table table{"ensemble", {"t"}, {}};
  for (const Quantity quantity : kQuantities)
    for (const Statistic& statistic : kStatistics)
      table.columns.push_back(std::string(name_of(quantity).id) + "_" + statistic.name);
  for (std::size_t i = 0; i < summary.times.size(); ++i) {
    std::vector<Cell> row = {summary.times[i]};
    for (const auto& at : summary.at)
      for (const Statistic& statistic : kStatistics) row.emplace_back(at[i].*statistic.value);
    table.rows.push_back(row);
  }
  return table;
}

Chart ensemble_chart(const EnsembleSummary& summary, Quantity quantity, bool seconds) {
  const char* label = name_of(quantity).label;
  Chart chart{label, seconds ? "time (s)" : "time (R^2/D)", label,
              true,  quantity != Quantity::fraction,        {}};
  chart.series = {band(summary, quantity, "all runs", &Sample::min, &Sample::max),
                  band(summary, quantity, "middle half", &Sample::q25, &Sample::q75),
                  {"median", {}, Mark::line}};
  const auto& at = summary.at[index_of(quantity)];
  for (std::size_t i = 0; i < at.size(); ++i)
    chart.series.back().points.emplace_back(summary.times[i], at[i].median);
  return chart;
}

void add_ensemble_origin(Page& page, const EnsembleFolder& folder,
                         const Configuration& configuration) {
  const EnsemblePlan plan = folder.load();
  add_settings(page, configuration);
  add_provenance(page, folder.path(),
                 command_for(formatted("traceraft ensemble --runs %d --first-seed ", plan.runs) +
                                 std::to_string(plan.first_seed),
                             configuration));
}

std::string write_ensemble(const EnsembleFolder& folder, const Configuration& configuration,
                           const EnsembleSummary& summary, const EnsembleEnd& end, bool quiet) {
  const bool seconds = !configuration.units().scaled;
  write_durably(folder.path() / "ensemble.csv", csv_text(ensemble_table(summary)));
  Page page("An ensemble of vesicles");
  page.paragraph(sentence_on(configuration, folder.load(), summary.runs));
  for (const MemberFailure& failure : end.failures)
    page.paragraph("The run of seed " + std::to_string(failure.seed) + " failed: " + failure.why);
  const std::vector<Row> rows = ensemble_rows(summary, seconds);
  if (!quiet) print_rows(rows);
  page.table(rows);
  Missing missing;
  for (const Quantity quantity : kQuantities)
    add_chart(page, ensemble_chart(summary, quantity, seconds),
              folder.path() / name_of(quantity).id, missing);
  add_ensemble_origin(page, folder, configuration);
  write_durably(folder.path() / "ensemble.html", page.html());
  return missing.text();
}

}  // namespace traceraft
