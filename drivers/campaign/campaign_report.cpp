#include "drivers/campaign/campaign_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "backends/posix/durable_file.hpp"
#include "drivers/input/csv_table.hpp"
#include "drivers/output/text_table.hpp"
#include "drivers/text/encoders.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"
#include "verification/selection/fit/refit.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::campaign {
namespace {

using Scores = std::vector<CaseScore>;

// The median of the finite values; NaN without any.
template <class Value>
double median_of(const Scores& scores, const Value& value) {
  std::vector<double> values;
  for (const CaseScore& score : scores)
    if (const double one = value(score); std::isfinite(one)) values.push_back(one);
  return values.empty() ? std::numeric_limits<double>::quiet_NaN()
                        : statistics::quantile(values, 0.5);
}

bench::Cell cell(double value) {
  return std::isfinite(value) ? bench::Cell(value) : bench::Cell("");
}

// The share of 95 % intervals that hold the truth.
bench::Cell coverage(const Scores& scores) {
  double known = 0, within = 0;
  for (const CaseScore& score : scores) {
    known += std::isfinite(score.deviations);
    within += std::fabs(score.deviations) <= statistics::kNormal95;
  }
  return known > 0 ? bench::Cell(within / known) : bench::Cell("");
}

std::map<std::string, Scores> by_group(const Scores& scores) {
  std::map<std::string, Scores> groups;
  for (const CaseScore& score : scores) groups[score.id.group].push_back(score);
  return groups;
}

// The share that was closed of what the truth would close of the held-out gap.
double closed(const CaseScore& score) {
  return assimilation::share_closed(score.base, score.named, score.floor)
      .value_or(std::numeric_limits<double>::quiet_NaN());
}

constexpr char kProgram[] = "program";  // earlier tables have no such column

bench::Table cases_table(const Scores& scores) {
  bench::Table table{"cases",
                     {"case", "hidden", "verdict", "found", "outcome", "error", "deviations", "p",
                      "base gap", "named gap", "placebo gap", "floor", "seconds", kProgram},
                     {}};
  for (const CaseScore& s : scores)
    table.rows.push_back({s.id.name(), s.hidden, s.verdict, s.effect, word_for(s.outcome),
                          cell(s.error), cell(s.deviations), cell(s.p), cell(s.base), cell(s.named),
                          cell(s.placebo), cell(s.floor), s.seconds, s.program});
  return table;
}

// One build may explain better than another.
std::string builds_of(const Scores& scores) {
  std::map<std::string, int> cases;
  for (const CaseScore& score : scores) ++cases[score.program];
  if (cases.size() < 2) return "";
  std::string text =
      "\nBuilds of the program that explained these cases, and the number of cases:\n\n";
  for (const auto& [program, count] : cases)
    text += "- " + (program.empty() ? "not known" : text::in_markdown(program)) +
            formatted(": %d\n", count);
  return text;
}

}  // namespace

bench::Table summary_of(const Scores& scores, const std::vector<CaseFailure>& failures) {
  bench::Table table{"summary",
                     {"group", "cases", "right", "in class", "missed", "wrong", "failed",
                      "wrong names", "median error", "coverage", "held-out gap / floor",
                      "placebo / named", "closed", "s per case"},
                     {}};
  for (const CampaignGroup& group : campaign_groups()) {
    const Scores own = by_group(scores)[group.name];
    const auto failed = static_cast<double>(
        std::count_if(failures.begin(), failures.end(),
                      [&](const CaseFailure& f) { return f.id.group == group.name; }));
    if (own.empty() && failed == 0) continue;
    const auto count = [&](CaseOutcome outcome) {
      return static_cast<double>(std::count_if(
          own.begin(), own.end(), [&](const CaseScore& s) { return s.outcome == outcome; }));
    };
    const bool names = group.aim == Aim::name;
    table.rows.push_back(
        {group.name, static_cast<double>(own.size()) + failed, count(CaseOutcome::right),
         count(CaseOutcome::in_class), count(CaseOutcome::missed), count(CaseOutcome::wrong),
         failed,
         static_cast<double>(std::count_if(own.begin(), own.end(),
                                           [](const CaseScore& s) {
                                             return s.outcome == CaseOutcome::wrong &&
                                                    !s.effect.empty();
                                           })),
         cell(median_of(own, [](const CaseScore& s) { return s.error; })), coverage(own),
         cell(median_of(own, [](const CaseScore& s) { return s.named / s.floor; })),
         names ? cell(median_of(own, [](const CaseScore& s) { return s.placebo / s.named; }))
               : bench::Cell(""),
         names ? cell(median_of(own, closed)) : bench::Cell(""),
         cell(median_of(own, [](const CaseScore& s) { return s.seconds; }))});
  }
  return table;
}

bench::Table confusion_of(const Scores& scores) {
  std::map<std::string, std::map<std::string, int>> counts;
  std::map<std::string, int> found;
  for (const CaseScore& score : scores) {
    const std::string verdict =
        score.effect.empty() ? score.verdict
                             : in_order(score.effect) +
                                   (score.outcome == CaseOutcome::in_class ? " (in class)" : "");
    ++counts[score.hidden.empty() ? "nothing" : in_order(score.hidden)][verdict];
    ++found[verdict];
  }
  bench::Table table{"confusion", {"hidden \\ found"}, {}};
  for (const auto& [name, count] : found) table.columns.push_back(name);
  for (const auto& [hidden, row] : counts) {
    table.rows.push_back({hidden});
    for (const auto& [name, count] : found)
      table.rows.back().push_back(row.count(name) ? bench::Cell(static_cast<double>(row.at(name)))
                                                  : bench::Cell(""));
  }
  return table;
}

void write_campaign(const CampaignFolder& campaign, const Scores& scores,
                    const std::vector<CaseFailure>& failures) {
  const std::filesystem::path& folder = campaign.path();
  const bench::Table summary = summary_of(scores, failures), confusion = confusion_of(scores);
  posix::write_durably(campaign.cases(), output::checked_csv_text(cases_table(scores)));
  posix::write_durably(folder / "summary.csv", output::csv_text(summary));
  posix::write_durably(folder / "confusion.csv", output::csv_text(confusion));
  std::string text = output::markdown_table(output::table_rows(summary));
  if (!confusion.rows.empty()) text += "\n" + output::markdown_table(output::table_rows(confusion));
  for (const auto& [group, own] : by_group(scores))
    if (const bench::Table alone = confusion_of(own); !alone.rows.empty())
      text += "\n" + text::in_markdown(group + ": " + campaign_groups().find(group).summary) +
              "\n\n" + output::markdown_table(output::table_rows(alone));
  text += builds_of(scores);
  if (!failures.empty()) text += "\nCases without a verdict:\n\n";
  for (const CaseFailure& failure : failures)
    text += "- " + text::in_markdown(failure.id.name() + ": " + failure.why) + "\n";
  posix::write_durably(folder / "campaign.md", text);
}

Scores read_cases(const std::filesystem::path& csv) {
  const input::CsvTable table = input::CsvTable::read(csv);
  for (const std::string& column : cases_table({}).columns)
    if (column != kProgram) table.require(column);
  Scores scores;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto text = [&](const char* column) { return table.text(row, column); };
    const auto number = [&](const char* column) {
      return table.empty(row, column) ? std::numeric_limits<double>::quiet_NaN()
                                      : table.number(row, column);
    };
    const auto ended = [&] {
      try {
        return std::pair(CaseId::of(text("case")), outcome_of(text("outcome")));
      } catch (const InputError& error) {
        throw InputError(table.where(row) + ": " + error.what());
      }
    }();
    scores.push_back({ended.first, text("hidden"), text("verdict"), text("found"), ended.second,
                      number("error"), number("deviations"), number("p"), number("base gap"),
                      number("named gap"), number("placebo gap"), number("floor"),
                      number("seconds"), table.has(kProgram) ? text(kProgram) : ""});
  }
  return scores;
}

}  // namespace traceraft::campaign
