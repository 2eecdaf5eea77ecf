#include "drivers/data/agreement_report.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/core/text.hpp"
#include "verification/observations/differences.hpp"
#include "verification/observations/onset.hpp"
#include "verification/observations/resolvable.hpp"

namespace traceraft::data {
namespace {

constexpr char kDeviations[] =
    "A deviation is measured minus the mean of the runs, in units of the scatter between runs and "
    "the uncertainty of the measurement. For perimeters and counts it is one of logarithms. ";

// Where there is nothing to compare, or nothing to measure deviations with, or nothing alike.
std::vector<std::string> doubts_of(const observations::MeasuredVesicles& data,
                                   const std::vector<observations::History>& runs,
                                   const std::vector<observations::Agreement>& agreements) {
  constexpr double kSmall = 0.02, kSome = 0.1;
  std::vector<std::string> sentences;
  if (std::all_of(agreements.begin(), agreements.end(),
                  [](const observations::Agreement& a) { return a.measurements == 0; }))
    sentences.push_back(
        "NOTHING IS COMPARED: no measurement lies at a time that all runs cover. Are time_unit and "
        "the time zero right?");
  if (const double share = observations::share_without_rafts(data, runs); share > kSome)
    sentences.push_back(
        formatted("THE SIMULATED VESICLES HAVE NO RAFTS at %.0f %% of the times of observation. "
                  "With this raft fraction and epsilon, rafts dissolve or never form.",
                  100 * share));
  for (const observations::Agreement& a : agreements)
    if (observations::lies_beside(a, runs.size()))
      sentences.push_back(
          formatted("THE MEASUREMENTS LIE OUTSIDE THE RANGE OF THE RUNS: the runs cover only %d of "
                    "%d measured values (%s). Runs of the right model would cover %.0f %% of them.",
                    a.within, a.measurements, observations::name_of(a.quantity).label,
                    100 * observations::same_kind(runs.size()).within));
  for (const observations::Agreement& a : agreements)
    if (a.measurements > 0 && a.scatter < kSmall)
      sentences.push_back(
          formatted("Runs and measurements scatter by only %.2g %% (%s). This scatter is the unit "
                    "of the deviations, so that small differences look large.",
                    100 * a.scatter, observations::name_of(a.quantity).label));
  for (const observations::Agreement& a : agreements)
    if (a.without_rafts > 0)
      sentences.push_back(
          std::string("Observations without a raft are left out of the ") +
          observations::name_of(a.quantity).label +
          ", which is compared by its logarithm: " + std::to_string(a.without_rafts) + ".");
  for (const observations::Agreement& a : agreements)
    if (a.has_trend())
      sentences.push_back(
          formatted("THE SIMULATIONS AND THE MEASUREMENTS CHANGE DIFFERENTLY: the deviations of "
                    "the %s have a trend of %+.2g +- %.1g per e-fold of time. A small mean "
                    "deviation then proves little. traceraft explain searches for what is missing.",
                    observations::name_of(a.quantity).label, a.trend, a.trend_error));
  return sentences;
}

}  // namespace

std::string about_agreement(std::size_t runs) {
  const observations::SameKind expected = observations::same_kind(runs);
  return kDeviations +
         formatted(
             "If vesicles were like these %zu runs and measured without error, %.0f %% of them "
             "would lie within the range of the runs",
             runs, 100 * expected.within) +
         (std::isfinite(expected.misfit)
              ? formatted(", and the misfit would be %.2f.", expected.misfit)
              : ". So few runs say nothing about the misfit.");
}

std::vector<output::Row> agreement_rows(const std::vector<observations::Agreement>& agreements) {
  std::vector<output::Row> rows = {{"quantity", "compared", "outside the runs' time",
                                    "within their range", "mean deviation", "misfit",
                                    "trend per e-fold of time"}};
  for (const observations::Agreement& a : agreements) {
    rows.push_back({observations::name_of(a.quantity).label, std::to_string(a.measurements),
                    std::to_string(a.beyond), "", "", "", ""});
    if (a.measurements == 0) continue;
    output::Row& row = rows.back();
    row[3] = formatted("%d (%.0f %%)", a.within, 100.0 * a.within / a.measurements);
    row[4] = formatted("%+.2f", a.bias);
    row[5] = formatted("%.2f", a.misfit);
    if (a.trend_error > 0) row[6] = formatted("%+.2f +- %.2f", a.trend, a.trend_error);
  }
  return rows;
}

bench::Table agreement_table(const std::vector<observations::Agreement>& agreements) {
  bench::Table table{"comparison",
                     {"quantity", "compared", "beyond", "without_rafts", "within_range",
                      "mean_deviation", "misfit", "trend", "trend_error"},
                     {}};
  for (const observations::Agreement& a : agreements) {
    table.rows.push_back({observations::name_of(a.quantity).id, static_cast<double>(a.measurements),
                          static_cast<double>(a.beyond), static_cast<double>(a.without_rafts), "",
                          "", "", "", ""});
    if (a.measurements == 0) continue;
    std::vector<bench::Cell>& row = table.rows.back();
    row[4] = static_cast<double>(a.within);
    row[5] = a.bias;
    row[6] = a.misfit;
    if (!(a.trend_error > 0)) continue;
    row[7] = a.trend;
    row[8] = a.trend_error;
  }
  return table;
}

std::string onset_note(const observations::MeasuredVesicles& data,
                       const std::vector<observations::History>& runs) {
  const auto onset = observations::onset_without_trend(data, runs);
  if (!onset) return "";
  std::vector<std::string> trends;
  for (const observations::Agreement& a : onset->agreements)
    if (a.trend_error > 0 && a.quantity != observations::Quantity::fraction)
      trends.push_back(formatted("%s %+.2g +- %.1g with a misfit of %.2f",
                                 observations::name_of(a.quantity).label, a.trend, a.trend_error,
                                 a.misfit));
  return formatted(
             "An onset %.3g s %safter the time zero of the measurements would remove the trend: ",
             onset->delay, onset->at_end ? "or more " : "") +
         joined(trends, ", ") +
         formatted(
             ". If rafts may have formed that late, set time_offset = %.4g in dataset.toml (in its "
             "time_unit; now it is %g) and calibrate again: this gives the D for that onset.",
             data.time_offset - onset->delay / data.time_unit, data.time_offset);
}

std::vector<std::string> cautions(const observations::MeasuredVesicles& data, double radius,
                                  const std::vector<observations::History>& runs,
                                  const std::vector<observations::Agreement>& agreements) {
  std::vector<std::string> all =
      observations::differences(data, observations::simulated_vesicle(radius, runs, data));
  for (const std::string& doubt : observations::doubts_about(data)) all.push_back(doubt);
  for (const std::string& doubt : doubts_of(data, runs, agreements)) all.push_back(doubt);
  if (const std::string onset = onset_note(data, runs); !onset.empty()) all.push_back(onset);
  return all;
}

}  // namespace traceraft::data
