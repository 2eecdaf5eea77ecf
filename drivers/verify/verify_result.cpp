#include "drivers/verify/verify_result.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace traceraft::verify {
namespace {

constexpr const char* kMarks[] = {"line", "points", "both", "band", "bars"};

input::Json number_or_null(double value) {
  return std::isfinite(value) ? input::Json(value) : input::Json();
}

double number_or(const input::Json& json, double otherwise) {
  return json.is_null() ? otherwise : json.get<double>();
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

input::Json to_json(const studies::Claim& claim) {
  return {{"claim", claim.what},
          {"measured", number_or_null(claim.measured)},
          {"uncertainty", claim.uncertainty > 0 ? input::Json(claim.uncertainty) : input::Json()},
          {"expected", claim.expected ? input::Json(*claim.expected) : input::Json()},
          {"low", number_or_null(claim.low)},
          {"high", number_or_null(claim.high)},
          {"holds", claim.holds()}};
}

studies::Claim claim_of(const input::Json& json) {
  studies::Claim claim{json.at("claim"),
                       number_or(json.at("measured"), kNaN),
                       {},
                       number_or(json.at("low"), -kInfinity),
                       number_or(json.at("high"), kInfinity),
                       number_or(json.at("uncertainty"), 0)};
  if (!json.at("expected").is_null()) claim.expected = json.at("expected").get<double>();
  return claim;
}

input::Json to_json(const bench::Table& table) {
  input::Json rows = input::Json::array();
  for (const auto& cells : table.rows) {
    input::Json row = input::Json::array();
    for (const bench::Cell& cell : cells)
      row.push_back(cell.is_number ? number_or_null(cell.number) : input::Json(cell.text));
    rows.push_back(row);
  }
  return {{"columns", table.columns}, {"rows", rows}};
}

[[noreturn]] void refuse(const std::string& what) {
  throw DamagedFile("the result of a study is damaged: " + what);
}

// Its name becomes one of a file.
bench::Table table_of(const std::string& name, const input::Json& json) {
  const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  if (name.empty() || name.find_first_not_of(plain) != std::string::npos)
    refuse("'" + name + "' is not a name for a table");
  bench::Table table{name, json.at("columns"), {}};
  for (const input::Json& cells : json.at("rows")) {
    std::vector<bench::Cell>& row = table.rows.emplace_back();
    for (const input::Json& cell : cells) {
      if (cell.is_string())
        row.emplace_back(cell.get<std::string>());
      else
        row.emplace_back(number_or(cell, kNaN));
    }
    if (row.size() != table.columns.size()) refuse("a row of " + name + " has too few cells");
  }
  return table;
}

input::Json numbers_or_null(const std::vector<double>& values) {
  input::Json list = input::Json::array();
  for (const double value : values) list.push_back(number_or_null(value));
  return list;
}

input::Json to_json(const bench::Chart& chart) {
  input::Json list = input::Json::array();
  for (const bench::ChartSeries& series : chart.series) {
    input::Json points = input::Json::array();
    for (const auto& [x, y] : series.points)
      points.push_back({number_or_null(x), number_or_null(y)});
    list.push_back({{"name", series.name},
                    {"mark", kMarks[static_cast<int>(series.mark)]},
                    {"points", points},
                    {"other", numbers_or_null(series.other)}});
  }
  return {{"title", chart.title}, {"x_label", chart.x_label}, {"y_label", chart.y_label},
          {"log_x", chart.log_x}, {"log_y", chart.log_y},     {"series", list}};
}

bench::Chart chart_of(const input::Json& json) {
  bench::Chart chart{json.at("title"), json.at("x_label"), json.at("y_label"),
                     json.at("log_x"), json.at("log_y"),   {}};
  for (const input::Json& item : json.at("series")) {
    bench::ChartSeries series{item.at("name"), {}};
    const auto mark = std::find(std::begin(kMarks), std::end(kMarks), item.at("mark"));
    if (mark == std::end(kMarks)) refuse("a mark of a chart is unknown");
    series.mark = static_cast<bench::Mark>(mark - std::begin(kMarks));
    for (const input::Json& point : item.at("points"))
      series.points.emplace_back(number_or(point.at(0), kNaN), number_or(point.at(1), kNaN));
    for (const input::Json& value : item.at("other"))
      series.other.push_back(number_or(value, kNaN));
    const bool has_other = series.mark == bench::Mark::band || series.mark == bench::Mark::bars;
    if (series.other.size() != (has_other ? series.points.size() : 0))
      refuse("a chart has too few values");
    chart.series.push_back(series);
  }
  return chart;
}

StudyResult result_of(const studies::StudyEntry& study, const input::Json& json) {
  StudyResult result{study, {}, json.at("failure"), json.at("seconds")};
  studies::StudyReport& report = result.report;
  report.skipped = json.at("skipped");
  report.notes = json.at("notes").get<std::vector<std::string>>();
  for (const input::Json& claim : json.at("claims")) report.claims.push_back(claim_of(claim));
  for (const auto& [name, table] : json.at("tables").items())
    report.tables.push_back(table_of(name, table));
  for (const input::Json& chart : json.at("charts")) report.charts.push_back(chart_of(chart));
  return result;
}

}  // namespace

const char* outcome_text(StudyOutcome outcome) {
  if (outcome == StudyOutcome::not_measured) return "not measured";
  return outcome == StudyOutcome::holds ? "holds" : "FAILS";
}

StudyOutcome StudyResult::outcome() const {
  if (!failure.empty()) return StudyOutcome::fails;
  if (!report.skipped.empty()) return StudyOutcome::not_measured;
  for (const studies::Claim& claim : report.claims)
    if (!claim.holds()) return StudyOutcome::fails;
  return report.claims.empty() ? StudyOutcome::fails : StudyOutcome::holds;
}

input::Json to_json(const StudyResult& result, const std::string& measured_with) {
  input::Json json;
  json["study"] = result.study.name;
  json["summary"] = result.study.summary;
  json["measured_with"] = measured_with;
  json["verdict"] = outcome_text(result.outcome());
  json["failure"] = result.failure;
  json["skipped"] = result.report.skipped;
  json["seconds"] = result.seconds;
  json["notes"] = result.report.notes;
  json["claims"] = input::Json::array();
  for (const studies::Claim& claim : result.report.claims) json["claims"].push_back(to_json(claim));
  json["tables"] = input::Json::object();
  for (const bench::Table& table : result.report.tables)
    json["tables"][table.name] = to_json(table);
  json["charts"] = input::Json::array();
  for (const bench::Chart& chart : result.report.charts) json["charts"].push_back(to_json(chart));
  return json;
}

std::optional<StudyResult> measured_before(const std::filesystem::path& folder,
                                           const studies::StudyEntry& study,
                                           const std::string& measured_with) {
  const std::filesystem::path file = folder / (study.name + ".json");
  if (!std::filesystem::exists(file)) return std::nullopt;
  return input::from_json(file, [&](const input::Json& json) -> std::optional<StudyResult> {
    // A study that could not be carried out is tried again.
    if (json.at("measured_with") != measured_with || json.at("failure") != "") return std::nullopt;
    return result_of(study, json);
  });
}

}  // namespace traceraft::verify
