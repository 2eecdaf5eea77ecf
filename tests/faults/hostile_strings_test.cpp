// Hostile text through everything that the program writes: nothing is executed, deleted or hidden.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "drivers/ensemble/array_job.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/page.hpp"
#include "drivers/output/text_table.hpp"
#include "drivers/text/encoders.hpp"
#include "drivers/text/utf8.hpp"
#include "kernel/core/error.hpp"
#include "tests/support/hostile.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::content;
using testing::hostile_texts;
using testing::json_of;
using testing::ProgramEnd;
using testing::shell;
using testing::TemporaryFolder;
using testing::traceraft;
namespace fs = std::filesystem;

// gnuplot itself is asked what it makes of the titles and names.
TEST(HostileStrings, ChartsExecuteNothing) {
  for (const std::string& text : hostile_texts()) {
    const TemporaryFolder folder;
    const bench::Chart chart{text,  text, text,
                             false, true, {{text, {{1, 1}, {2, 3}}, bench::Mark::both}}};
    std::string svg;
    ASSERT_NO_THROW(svg = output::draw_chart(chart, folder.path / "chart"))
        << text << content(folder.path / "chart.log");
    ASSERT_NE(svg, "") << "is gnuplot installed?";
    EXPECT_EQ(folder.entries(), 3u) << "something else was written for: " << text;
    EXPECT_EQ(svg.find("<script"), std::string::npos) << text;
  }
}

TEST(HostileStrings, ChartsHavePlainNames) {
  const TemporaryFolder folder;
  const bench::Chart chart{"t", "x", "y", false, false, {{"s", {{1, 1}, {2, 3}}}}};
  for (const std::string& name : hostile_texts()) {
    if (name.find('/') != std::string::npos) continue;  // a folder
    EXPECT_THROW(output::draw_chart(chart, folder.path / name), std::logic_error)
        << name.substr(0, 60);
  }
  EXPECT_EQ(folder.entries(), 0u);
}

// The folder may have any name.
TEST(HostileStrings, FoldersExecuteNothing) {
  for (const char* name : {"|touch hit;:", "<touch hit;:", "$(touch hit)", "`touch hit`", "a'b",
                           "; touch hit", "-rf"}) {
    const TemporaryFolder folder;
    const auto within = [&](const std::string& arguments) {
      return shell("cd " + folder.path.string() + " && exec " + TRACERAFT_PROGRAM + " " +
                   arguments);
    };
    ASSERT_EQ(within("run --quiet --case two-rafts --cells 12 --epsilon 1 "
                     "--t-end 0.1 --out=" +
                     text::in_shell(name))
                  .code,
              0);
    const ProgramEnd report = within("report -- " + text::in_shell(name));
    EXPECT_EQ(report.code, 0) << report.output;
    EXPECT_EQ(report.output.find("missing"), std::string::npos) << report.output;
    EXPECT_EQ(folder.entries(), 1u) << name;
  }
}

TEST(HostileStrings, ScriptsOfArrayJobsExecuteOneCommand) {
  for (const std::string& text : hostile_texts()) {
    if (text.find('\0') != std::string::npos || text.size() > 255) continue;
    const TemporaryFolder folder;
    const fs::path ensemble = folder.path / fs::path(text).relative_path();
    const std::string script =
        ensemble::array_job_script(ensemble::EnsembleFolder(ensemble), {}, {1, 1, 10, 1}, {});
    // `exec` is replaced by a function that says what it was asked to execute.
    posix::write_durably(folder.path / "job.sh",
                         "cd " + text::in_shell(folder.path.string()) +
                             "\ntold() { for word; do printf '[%s]' \"$word\"; done; }\n" +
                             std::string(script).replace(script.rfind("\nexec "), 6, "\ntold "));
    const ProgramEnd end = shell("SLURM_ARRAY_TASK_ID=0 sh " + (folder.path / "job.sh").string());
    EXPECT_EQ(end.output.find("[ensemble][--out]["), end.output.find(']') + 1) << end.output;
    EXPECT_NE(end.output.find("[--member][1]"), std::string::npos) << end.output;
    EXPECT_EQ(folder.entries(), 1u) << text;
  }
}

TEST(HostileStrings, PagesAndTablesHoldText) {
  for (const std::string& text : hostile_texts()) {
    output::Page page(text);
    page.heading(text);
    page.paragraph(text);
    page.code(text);
    page.figure("", text);
    page.table({{text, text}, {text, text}});
    std::string html = page.html();
    EXPECT_EQ(html.find("<script"), std::string::npos) << text;
    EXPECT_EQ(html.find("<img"), std::string::npos) << text;
    EXPECT_TRUE(text::is_utf8(html));
    const std::string markdown = output::markdown_table({{"a", "b"}, {text, text}});
    EXPECT_EQ(std::count(markdown.begin(), markdown.end(), '\n'), 4) << markdown;
    EXPECT_EQ(markdown.find("<script"), std::string::npos);
  }
}

// Files that the program reads back, with everything in them that somebody could have put there.
class TamperedFilesTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  std::string at(const char* name) const { return (folder.path / name).string(); }
};

TEST_F(TamperedFilesTest, ResultsOfStudiesExecuteNothing) {
  const std::string out = " --quick --quiet --out " + at("v");
  ASSERT_EQ(traceraft("verify geometry" + out).code, 0);
  const nlohmann::json good = json_of(at("v/geometry.json"));
  nlohmann::json bad = good;
  ASSERT_FALSE(bad.at("charts").empty());
  bad["charts"][0]["title"] = "x\nsystem \"touch " + at("hit") + "\"\n<script>alert(1)</script>";
  bad["notes"] = {"<script>alert(1)</script>\n# heading"};
  posix::write_durably(at("v/geometry.json"), bad.dump());
  EXPECT_EQ(traceraft("verify geometry" + out + " --document " + at("d.md")).code, 0);
  EXPECT_FALSE(fs::exists(at("hit")));
  EXPECT_EQ(content(at("d.md")).find("<script"), std::string::npos);
  EXPECT_EQ(content(at("v/verify.html")).find("<script"), std::string::npos);
  bad = good;
  bad["tables"]["../../hit"] = bad["tables"].front();
  posix::write_durably(at("v/geometry.json"), bad.dump());
  EXPECT_EQ(traceraft("verify geometry" + out).code, 4);
}

TEST_F(TamperedFilesTest, PlansDeleteNothing) {
  const std::string compare = "compare --quiet --out " + at("c") + " --references " + at("ref");
  ASSERT_EQ(traceraft(compare + " --case two-rafts --cells 12 --epsilon 1 --t-end 0.1 "
                                "--integrators ida --tolerances 1e-2 --repeat 1")
                .code,
            0);
  fs::create_directories(at("victim"));
  posix::write_durably(at("victim/mine"), "of somebody");
  const nlohmann::json good = json_of(at("c/plan.json"));
  const auto complaint = [&](const char* member, const nlohmann::ordered_json& value, int code) {
    nlohmann::json bad = good;
    bad[member] = value;
    posix::write_durably(at("c/plan.json"), bad.dump());
    const ProgramEnd end = traceraft(compare);
    EXPECT_EQ(end.code, code) << member << ": " << end.output;
    EXPECT_EQ(std::count(end.output.begin(), end.output.end(), '\n'), 1) << end.output;
    return end.output;
  };
  EXPECT_NE(complaint("integrators", {"../../victim"}, 2).find("unknown integrator"),
            std::string::npos);
  for (const double repeat : {-5.0, 0.0, 2147483647.0, 1e8, 1e300})
    EXPECT_NE(complaint("repeat", repeat, 2).find("allowed: 1 to 1000"), std::string::npos);
  (void)complaint("tolerances", {7}, 2);
  (void)complaint("ranks", {-1}, 2);
  (void)complaint("ranks", "1", 4);
  (void)complaint("integrators", nlohmann::ordered_json::array(), 4);
  (void)complaint("tolerances", {0.01, 0.01}, 4);
  (void)complaint("repeet", 1, 4);
  EXPECT_NE(complaint("integrators", {"i\x1b[2J"}, 2).find("\\x1b"), std::string::npos);
  posix::write_durably(at("c/plan.json"), "{\"integrators\": [");
  const ProgramEnd torn = traceraft(compare);
  EXPECT_EQ(torn.code, 4);
  EXPECT_EQ(torn.output.find("json.exception"), std::string::npos) << torn.output;
  EXPECT_EQ(content(at("victim/mine")), "of somebody");
  // A file of somebody in the folder of a run that was interrupted.
  posix::write_durably(at("c/plan.json"), good.dump());
  fs::remove(at("c/runs/ida-block-0.01-1.json"));
  posix::write_durably(at("c/runs/ida-block-0.01-1/notes.txt"), "of somebody");
  const ProgramEnd end = traceraft(compare);
  EXPECT_EQ(end.code, 4) << end.output;
  EXPECT_NE(end.output.find("notes.txt"), std::string::npos) << end.output;
  EXPECT_EQ(content(at("c/runs/ida-block-0.01-1/notes.txt")), "of somebody");
  fs::remove(at("c/runs/ida-block-0.01-1/notes.txt"));
  EXPECT_EQ(traceraft(compare).code, 0);
}

TEST_F(TamperedFilesTest, PlansOfEnsemblesAndCampaignsAreChecked) {
  ASSERT_EQ(traceraft("ensemble --quiet --array-job --case spinodal --cells 12 --t-end 0.01 "
                      "--runs 2 --out " +
                      at("e"))
                .code,
            0);
  for (const char* runs : {"-5", "0", "2147483647", "1e8"}) {
    posix::write_durably(at("e/plan.json"),
                         "{\"runs\": " + std::string(runs) + ", \"first_seed\": 1}");
    const ProgramEnd end = traceraft("ensemble --quiet --out " + at("e"));
    EXPECT_EQ(end.code, 2) << end.output;
    EXPECT_NE(end.output.find("allowed: 1 to 1e+05"), std::string::npos) << end.output;
  }
  fs::create_directories(at("k/cases"));
  const std::string plan =
      "{\"groups\": [\"naming\"], \"cases\": 1, \"seed\": 1, \"points\": 100, \"model\": {}, "
      "\"replicates\": 49, \"effects\": 1}";
  for (const auto& [from, to] :
       {std::pair("naming", "../../victim"), std::pair("\"cases\": 1", "\"cases\": 100000000"),
        std::pair("\"points\": 100", "\"points\": 1e12"), std::pair("{}", "{\"cels\": \"3\"}"),
        std::pair("{}", "{\"cells\": \"3\"}"), std::pair("49", "-49")}) {
    std::string bad = plan;
    bad.replace(bad.find(from), std::string(from).size(), to);
    posix::write_durably(at("k/plan.json"), bad);
    const ProgramEnd end = traceraft("campaign --quiet --out " + at("k"));
    EXPECT_EQ(end.code, 2) << bad << end.output;
    EXPECT_EQ(std::count(end.output.begin(), end.output.end(), '\n'), 1) << end.output;
  }
}

TEST_F(TamperedFilesTest, NamesOfDataReachTheTerminalAsText) {
  fs::create_directories(at("d"));
  posix::write_durably(at("d/dataset.toml"),
                       "name = \"a\\u001b]0;title\\u0007\\u001b[2J\\u202e\"\nkind = \"measured\"\n"
                       "time_zero = \"\\u009b31m\"\nlength_unit = \"um\"\ntime_unit = \"s\"\n"
                       "radius = 5\n");
  posix::write_durably(at("d/measurements.csv"),
                       "vesicle,time,perimeter\n1,10,20\n1,20,15\n1,40,12\n");
  const ProgramEnd end = traceraft("data check " + at("d"));
  EXPECT_EQ(end.code, 0) << end.output;
  for (const char* sequence : {"\x1b", "\x07", "\xC2\x9B", "\xE2\x80\xAE"})
    EXPECT_EQ(end.output.find(sequence), std::string::npos) << end.output;
  EXPECT_NE(end.output.find("\\x1b[2J"), std::string::npos) << end.output;
}

TEST_F(TamperedFilesTest, FoldersOfOthersAreRefused) {
  const std::string run = "run --quiet --case two-rafts --cells 12 --epsilon 1 --t-end 0.1 --out ";
  fs::create_directories(at("mine"));
  posix::write_durably(at("mine/notes.txt"), "of somebody");
  for (const std::string& folder_of_others : {std::string("/"), at("mine")})
    for (const std::string& command :
         {run, std::string("compare --quiet --case two-rafts --out "),
          std::string("verify mass --quick --quiet --out "),
          std::string("ensemble --quiet --case spinodal --out "), std::string("hide --out "),
          std::string("campaign --quiet --out ")}) {
      const ProgramEnd end = traceraft(command + folder_of_others);
      EXPECT_EQ(end.code, 2) << command << folder_of_others << ": " << end.output;
    }
  std::size_t entries = 0;
  for (const auto& entry : fs::directory_iterator(at("mine"))) entries += entry.exists();
  EXPECT_LE(entries, 2u) << "more than a lock was left";
  // Links in a folder that is otherwise empty.
  for (const char* link : {"config.toml", "config.toml.part", "series.csv"}) {
    fs::create_directories(at("linked"));
    fs::create_symlink(at("hit"), fs::path(at("linked")) / link);
    EXPECT_EQ(traceraft(run + at("linked")).code, 2) << link;
    EXPECT_FALSE(fs::exists(at("hit"))) << link;
    fs::remove_all(at("linked"));
  }
}

}  // namespace
}  // namespace traceraft
