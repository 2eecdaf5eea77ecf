#include "drivers/verify/verify_report.hpp"

#include <cmath>

#include "backends/posix/durable_file.hpp"
#include "backends/posix/folder_lock.hpp"
#include "backends/posix/own_files.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/page.hpp"
#include "drivers/output/text_table.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::verify {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestChart = 1 << 24;  // bytes

std::string measured_text(const studies::Claim& claim) {
  const std::string value = formatted("%.4g", claim.measured);
  return claim.uncertainty > 0 ? value + formatted(" +- %.1g", claim.uncertainty) : value;
}

output::Row claim_row(const studies::Claim& claim) {
  output::Row row = {claim.what, measured_text(claim)};
  if (claim.expected) {
    row.push_back(output::short_number(*claim.expected));
    row.push_back("+- " + formatted("%.3g", 0.5 * (claim.high - claim.low)));
  } else if (std::isinf(claim.low)) {
    row.push_back("at most " + output::short_number(claim.high));
    row.push_back("");
  } else if (std::isinf(claim.high)) {
    row.push_back("at least " + output::short_number(claim.low));
    row.push_back("");
  } else {
    row.push_back(output::short_number(claim.low) + " to " + output::short_number(claim.high));
    row.push_back("");
  }
  row.push_back(outcome_text(claim.holds() ? StudyOutcome::holds : StudyOutcome::fails));
  return row;
}

// For readers of the page and of the document.
constexpr const char* kIntroduction[] = {
    "A study measures numbers. A claim says what one of them must be. The column expected has the "
    "value by theory, or a bound. The column tolerance says how far the measured number may differ "
    "from that value. A measured number may have an uncertainty, half of a 95 % interval, which "
    "does not enter the verdict. The verdict is holds or FAILS.",
    "Lengths are in units of the radius R and times in units of R^2/D. Epsilon is the width "
    "parameter of a phase boundary, h the mesh size, c the concentration.",
    "If a claim fails, repeat its study alone: claims about times need a machine without other "
    "load. If it fails again, do not trust results of this build. Compare the tables of the study "
    "with docs/verification.md, check compiler and libraries, and report the failure with the "
    "folder of the verification."};

std::string outcome_sentence(const StudyResult& result) {
  if (!result.failure.empty()) return "FAILS: " + result.failure + ".";
  if (!result.report.skipped.empty()) return "Not measured: " + result.report.skipped + ".";
  return "";
}

std::vector<output::Row> overview_rows(const std::vector<StudyResult>& results) {
  std::vector<output::Row> rows = {{"study", "what", "claims", "verdict", "seconds"}};
  for (const StudyResult& result : results)
    rows.push_back({result.study.name, result.study.summary,
                    std::to_string(result.report.claims.size()), outcome_text(result.outcome()),
                    formatted("%.1f", result.seconds)});
  return rows;
}

std::string chart_name(const StudyResult& result, std::size_t number) {
  return result.study.name + "-" + std::to_string(number + 1);
}

// Draws charts into the folder and the page. "" or why some are missing.
std::string draw_charts(const fs::path& folder, const StudyResult& result, output::Page& page) {
  std::string missing;
  for (std::size_t k = 0; k < result.report.charts.size(); ++k) {
    const bench::Chart& chart = result.report.charts[k];
    try {
      const std::string svg = output::draw_chart(chart, folder / chart_name(result, k));
      if (svg.empty()) return output::kNoGnuplot;
      page.figure(svg, chart.title);
    } catch (const IoError& error) {  // the tables are worth more than their pictures
      missing = error.what();
    }
  }
  return missing;
}

}  // namespace

std::vector<output::Row> claim_rows(const std::vector<studies::Claim>& claims) {
  std::vector<output::Row> rows = {{"claim", "measured", "expected", "tolerance", "verdict"}};
  for (const studies::Claim& claim : claims) rows.push_back(claim_row(claim));
  return rows;
}

void print_result(const StudyResult& result) {
  for (const bench::Table& table : result.report.tables) {
    output::print_rows(output::table_rows(table));
    text::say("\n");
  }
  for (const std::string& note : result.report.notes) text::say("  %s\n", note);
  if (!result.report.notes.empty()) text::say("\n");
  if (!result.report.claims.empty()) output::print_rows(claim_rows(result.report.claims));
  if (const std::string outcome = outcome_sentence(result); !outcome.empty())
    text::say("  %s\n", outcome);
  text::say("\n  %.1f s\n\n", result.seconds);
  text::flush_output();
}

std::vector<std::string> files_of_a_verification() {
  std::vector<std::string> names = run::files_of_a_report();
  names.insert(names.end(), {posix::kLockFile, "verify.json", "verify.html", "ranks/log"});
  for (const studies::StudyEntry& study : studies::studies())
    for (const char* ending : {".json", "-*.csv", "-*.gp", "-*.svg", "-*.log"})
      names.push_back(study.name + ending);
  for (const std::string& name : run::files_of_a_run()) names.push_back("ranks/run/" + name);
  return names;
}

void write_study(const fs::path& folder, const StudyResult& result, const std::string& with) {
  for (const bench::Table& table : result.report.tables)
    posix::write_durably(folder / (result.study.name + "-" + table.name + ".csv"),
                         output::csv_text(table));
  input::write_json(folder / (result.study.name + ".json"), to_json(result, with));
}

std::string write_verification(const fs::path& folder, const VerificationContext& context,
                               const std::vector<StudyResult>& results) {
  input::Json all;
  all["command"] = context.command;
  all["conditions"] = context.conditions;
  input::Json studies = input::Json::array();
  for (const StudyResult& result : results)
    studies.push_back(to_json(result, context.measured_with));
  all["studies"] = studies;
  // Folders may have names that are not UTF-8.
  input::write_json(folder / "verify.json", all);

  output::Page page("Verification");
  page.paragraph(context.conditions + " This command repeats it: " + context.command);
  for (const char* paragraph : kIntroduction) page.paragraph(paragraph);
  page.table(overview_rows(results));
  std::string missing;
  for (const StudyResult& result : results) {
    page.heading(result.study.name + ": " + result.study.summary);
    if (const std::string outcome = outcome_sentence(result); !outcome.empty())
      page.paragraph(outcome);
    for (const std::string& note : result.report.notes) page.paragraph(note);
    if (!result.report.claims.empty()) page.table(claim_rows(result.report.claims));
    if (const std::string why = draw_charts(folder, result, page); !why.empty()) missing = why;
    for (const bench::Table& table : result.report.tables) page.table(output::table_rows(table));
  }
  if (!missing.empty()) page.paragraph("Missing charts: " + missing + ".");
  posix::write_durably(folder / "verify.html", page.html());
  return missing;
}

void write_document(const fs::path& path, const fs::path& folder,
                    const VerificationContext& context, const std::vector<StudyResult>& results) {
  fs::path figures = path;
  figures.replace_extension();
  posix::make_inner_folder(figures);
  std::string text = "# Verification\n\n" + text::in_markdown(context.conditions) +
                     "\nThis command writes this document and its figures:\n\n    " +
                     text::in_markdown_code(context.command) + "\n\n";
  for (const char* paragraph : kIntroduction) text += text::in_markdown(paragraph) + "\n\n";
  text += output::markdown_table(overview_rows(results), output::MarkdownLinks::to_headings);
  for (const StudyResult& result : results) {
    text += "## " + result.study.name + "\n\n`traceraft verify " + result.study.name +
            "`: " + text::in_markdown(result.study.summary) + ".\n";
    for (const std::string& note : result.report.notes) text += text::in_markdown(note) + "\n";
    text += "\n";
    if (const std::string outcome = outcome_sentence(result); !outcome.empty())
      text += text::in_markdown(outcome) + "\n\n";
    if (!result.report.claims.empty())
      text += output::markdown_table(claim_rows(result.report.claims));
    for (std::size_t k = 0; k < result.report.charts.size(); ++k) {
      const std::string name = chart_name(result, k) + ".svg";
      if (!fs::exists(folder / name)) continue;
      posix::write_durably(figures / name, posix::read_file(folder / name, kLargestChart));
      text += "![" + text::in_markdown(result.report.charts[k].title) + "](" +
              text::in_markdown_link(figures.filename().string() + "/" + name) + ")\n\n";
    }
    for (const bench::Table& table : result.report.tables)
      if (table.rows.size() <= 40) text += output::markdown_table(output::table_rows(table));
  }
  posix::write_durably(path, text);
}

}  // namespace traceraft::verify
