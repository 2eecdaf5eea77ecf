#include "drivers/ensemble/ensemble_report.hpp"

#include "backends/posix/durable_file.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/provenance.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::ensemble {
namespace {

constexpr int kPerDecade = 24;

struct Statistic {
  const char* name;
  double statistics::Sample::*value;
};
constexpr Statistic kStatistics[] = {
    {"mean", &statistics::Sample::mean}, {"sd", &statistics::Sample::deviation},
    {"min", &statistics::Sample::min},   {"q10", &statistics::Sample::q10},
    {"q25", &statistics::Sample::q25},   {"median", &statistics::Sample::median},
    {"q75", &statistics::Sample::q75},   {"q90", &statistics::Sample::q90},
    {"max", &statistics::Sample::max}};

bench::ChartSeries band(const EnsembleSummary& summary, observations::Quantity quantity,
                        const char* name, double statistics::Sample::*low,
                        double statistics::Sample::*high) {
  bench::ChartSeries series{name, {}, bench::Mark::band};
  const auto& at = summary.at[observations::index_of(quantity)];
  for (std::size_t i = 0; i < at.size(); ++i) {
    series.points.emplace_back(summary.times[i], at[i].*low);
    series.other.push_back(at[i].*high);
  }
  return series;
}

std::string sentence_on(const config::Configuration& configuration, const EnsemblePlan& plan,
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

std::vector<output::Row> ensemble_rows(const EnsembleSummary& summary, bool seconds) {
  std::vector<output::Row> rows = {{seconds ? "time (s)" : "time"}};
  for (const observations::Quantity quantity : observations::kQuantities)
    rows.front().push_back(std::string(observations::name_of(quantity).label) + ", median (range)");
  for (std::size_t i = 0; i < summary.times.size(); ++i) {
    if (i % kPerDecade != 0 && i + 1 != summary.times.size()) continue;
    output::Row row = {output::short_number(summary.times[i])};
    for (const auto& at : summary.at)
      row.push_back(output::short_number(at[i].median) + " (" + output::short_number(at[i].min) +
                    " to " + output::short_number(at[i].max) + ")");
    rows.push_back(row);
  }
  return rows;
}

EnsembleSummary summarise(const std::vector<observations::History>& runs) {
  EnsembleSummary summary{runs.size(), {}, {}};
  summary.times = observations::common_times(runs, kPerDecade);
  if (summary.times.empty()) throw InputError("the runs of the ensemble have no times in common");
  for (const observations::Quantity quantity : observations::kQuantities)
    summary.at[observations::index_of(quantity)] =
        observations::samples_at(runs, quantity, summary.times);
  return summary;
}

bench::Table ensemble_table(const EnsembleSummary& summary) {
  bench::Table table{"ensemble", {"t"}, {}};
  for (const observations::Quantity quantity : observations::kQuantities)
    for (const Statistic& statistic : kStatistics)
      table.columns.push_back(std::string(observations::name_of(quantity).id) + "_" +
                              statistic.name);
  for (std::size_t i = 0; i < summary.times.size(); ++i) {
    std::vector<bench::Cell> row = {summary.times[i]};
    for (const auto& at : summary.at)
      for (const Statistic& statistic : kStatistics) row.emplace_back(at[i].*statistic.value);
    table.rows.push_back(row);
  }
  return table;
}

bench::Chart ensemble_chart(const EnsembleSummary& summary, observations::Quantity quantity,
                            bool seconds) {
  const char* label = observations::name_of(quantity).label;
  bench::Chart chart{label, seconds ? "time (s)" : "time (R^2/D)",        label,
                     true,  quantity != observations::Quantity::fraction, {}};
  chart.series = {
      band(summary, quantity, "all runs", &statistics::Sample::min, &statistics::Sample::max),
      band(summary, quantity, "middle half", &statistics::Sample::q25, &statistics::Sample::q75),
      {"median", {}, bench::Mark::line}};
  const auto& at = summary.at[observations::index_of(quantity)];
  for (std::size_t i = 0; i < at.size(); ++i)
    chart.series.back().points.emplace_back(summary.times[i], at[i].median);
  return chart;
}

void add_ensemble_origin(output::Page& page, const EnsembleFolder& folder,
                         const config::Configuration& configuration) {
  const EnsemblePlan plan = folder.load();
  output::add_settings(page, configuration);
  output::add_provenance(
      page, folder.path(),
      output::command_for(formatted("traceraft ensemble --runs %d --first-seed ", plan.runs) +
                              std::to_string(plan.first_seed),
                          configuration));
}

std::string write_ensemble(const EnsembleFolder& folder, const config::Configuration& configuration,
                           const EnsembleSummary& summary, const EnsembleEnd& end, bool quiet) {
  const bool seconds = !configuration.units().scaled;
  posix::write_durably(folder.path() / "ensemble.csv", output::csv_text(ensemble_table(summary)));
  output::Page page("An ensemble of vesicles");
  page.paragraph(sentence_on(configuration, folder.load(), summary.runs));
  for (const MemberFailure& failure : end.failures)
    page.paragraph("The run of seed " + std::to_string(failure.seed) + " failed: " + failure.why);
  const std::vector<output::Row> rows = ensemble_rows(summary, seconds);
  if (!quiet) output::print_rows(rows);
  page.table(rows);
  output::Missing missing;
  for (const observations::Quantity quantity : observations::kQuantities)
    output::add_chart(page, ensemble_chart(summary, quantity, seconds),
                      folder.path() / observations::name_of(quantity).id, missing);
  add_ensemble_origin(page, folder, configuration);
  posix::write_durably(folder.path() / "ensemble.html", page.html());
  return missing.text();
}

}  // namespace traceraft::ensemble
