#include "drivers/data/measured_report.hpp"

#include <algorithm>
#include <cmath>

#include "backends/posix/durable_file.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/data/law_report.hpp"
#include "drivers/ensemble/ensemble_report.hpp"
#include "drivers/ensemble/histories_file.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/page.hpp"
#include "drivers/output/text_table.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"
#include "verification/observations/raft_fraction.hpp"
#include "verification/observations/resolvable.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::data {
namespace {

namespace fs = std::filesystem;

std::string spread(const std::vector<double>& values) {
  if (values.empty()) return "not measured";
  const statistics::Sample d = statistics::sample_of(values);
  return formatted("%.4g +- %.2g, from %.4g to %.4g (%zu measurements)", d.mean, d.deviation, d.min,
                   d.max, values.size());
}

std::vector<double> values_of(const observations::MeasuredVesicles& data,
                              observations::Quantity quantity) {
  std::vector<double> values;
  for (const observations::Measurement& m : data.measurements)
    if (m.of(quantity)) values.push_back(*m.of(quantity));
  return values;
}

// From composition and temperature alone.
std::string estimated_fraction(const std::string& composition, double celsius) {
  try {
    const observations::RaftFractionEstimate estimate = observations::estimated_raft_fraction(
        observations::membrane_mixture("composition", composition), celsius);
    return formatted("%.4g, ", estimate.area) + estimate.how;
  } catch (const InputError& error) {
    return std::string("unknown (") + error.what() + ")";
  }
}

std::string missing_of(const ensemble::EnsembleFolder& folder,
                       const ensemble::FinishedMembers& finished) {
  const int planned = folder.load().runs;
  const std::size_t there = finished.seeds.size();
  if (there == static_cast<std::size_t>(planned)) return "";
  std::string text = "ONLY " + std::to_string(there) + " OF " + std::to_string(planned) +
                     " RUNS of " + folder.path().string() +
                     " have finished. Continue with: traceraft ensemble --out " +
                     text::in_shell(folder.path().string()) + ".";
  for (const ensemble::MemberFailure& damaged : finished.damaged)
    text += " Seed " + std::to_string(damaged.seed) + ": " + damaged.why + ".";
  return text;
}

}  // namespace

bench::ChartSeries measured_points(const observations::MeasuredVesicles& data,
                                   observations::Quantity quantity, double unit) {
  bench::ChartSeries measured{origin_of(data), {}, bench::Mark::bars};
  for (const observations::Measurement& m : data.measurements) {
    if (!m.of(quantity)) continue;
    measured.points.emplace_back(m.time, unit * *m.of(quantity));
    measured.other.push_back(unit * m.sigma_of(quantity));
  }
  return measured;
}

bench::Chart comparison_chart(const observations::MeasuredVesicles& data,
                              const ensemble::EnsembleSummary& summary,
                              observations::Quantity quantity) {
  bench::Chart chart = ensemble::ensemble_chart(summary, quantity, true);
  double first = HUGE_VAL;
  for (const observations::Measurement& m : data.measurements) first = std::min(first, m.time);
  for (bench::ChartSeries& series : chart.series) {
    std::size_t early = 0;
    while (early < series.points.size() && series.points[early].first < 0.1 * first) ++early;
    series.points.erase(series.points.begin(), series.points.begin() + early);
    if (!series.other.empty())
      series.other.erase(series.other.begin(), series.other.begin() + early);
  }
  chart.series.push_back(measured_points(data, quantity));
  return chart;
}

std::string origin_of(const observations::MeasuredVesicles& data) {
  return data.synthetic ? "synthetic measurements" : "measured";
}

std::string title_of(const observations::MeasuredVesicles& data) {
  const bool said = data.name.find("SYNTHETIC") != std::string::npos;
  return data.name + (data.synthetic && !said ? " (SYNTHETIC, not measured)" : "");
}

std::string about_data(const observations::MeasuredVesicles& data) {
  return title_of(data) + ": " + std::to_string(data.vesicles().size()) + " vesicles, " +
         std::to_string(data.measurements.size()) + " measurements" +
         (data.origin.empty() ? "" : "; " + data.origin);
}

void print_dataset(const observations::MeasuredVesicles& data,
                   const std::optional<observations::FittedLaw>& law,
                   const statistics::Window& window) {
  text::say("%s\n", about_data(data));
  double first = HUGE_VAL, last = 0;
  std::vector<double> radii;
  for (const observations::Measurement& m : data.measurements) {
    first = std::min(first, m.time);
    last = std::max(last, m.time);
    radii.push_back(m.radius);
  }
  text::say("  %-22s %.4g to %.4g s after time zero (%s)\n", "time", first, last, data.time_zero);
  text::say("  %-22s %s\n", "radius (um)", spread(radii));
  for (const observations::Quantity quantity : observations::kQuantities)
    text::say("  %-22s %s\n", observations::name_of(quantity).label,
              spread(values_of(data, quantity)));
  if (!data.composition.empty() && data.celsius)
    text::say("  %-22s %s\n", "estimated fraction",
              estimated_fraction(data.composition, *data.celsius));
  for (const std::string& doubt : observations::doubts_about(data))
    text::say("\nNOTE: %s\n", doubt);
  text::say("\npower law from %g to %g s\n", window.begin, window.end);
  output::print_rows({law_heading(), law_row(origin_of(data), law)});
  for (const std::string& remark : remarks_on({law})) text::say("%s\n", remark);
}

config::Configuration model_of(const fs::path& path) {
  const ensemble::EnsembleFolder folder(path);
  if (!folder.started() &&
      !(fs::exists(folder.config()) && fs::exists(path / ensemble::kHistoriesFile)))
    throw InputError("--ensemble: " + path.string() + " holds no ensemble (traceraft ensemble)");
  const config::Configuration configuration(config::read_config_file(folder.config()), {});
  if (configuration.units().scaled)
    throw InputError("--ensemble: " + path.string() +
                     " was run with --scaled; its times are not in seconds and cannot be compared");
  return configuration;
}

EnsembleRuns runs_of(const fs::path& path) {
  const config::Configuration model = model_of(path);
  const ensemble::EnsembleFolder folder(path);
  const fs::path kept = path / ensemble::kHistoriesFile;
  if (folder.started()) {
    ensemble::FinishedMembers finished = ensemble::finished_members(folder, model);
    if (!finished.histories.empty()) {
      const std::string missing = missing_of(folder, finished);
      return {std::move(finished.histories), missing};
    }
    if (!fs::exists(kept)) return {};
  }
  return {ensemble::read_histories(kept), ""};
}

}  // namespace traceraft::data
